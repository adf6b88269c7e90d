// SPDX-License-Identifier: GPL-2.0-or-later
// Every law in one contact per thread, with every model beside it, as a code for GPUs calls it. A host makes the
// constants and copies them to the device.
#include <epdem/contact.hpp>
#include <epdem/impact.hpp>
#include <epdem/laws.hpp>

using namespace epdem;

/// One contact with the friction model at this place of the list.
template <bool wall, class Law, class Growth>
void act(const ContactConstants<Law>& pair, const ContactSettings& settings, const Kinematics<double>& motion,
         int friction, double* numbers, Growth& growth, ContactLoads<double>& loads) {
  Frictions::each([&](auto model, int place) {
    using Friction = decltype(model);
    using History = ContactHistory<Law, Friction, Vec<double>, Growth>;
    if constexpr (!adheres<Law> || Friction::of_liggghts)
      if (place == friction) {
        History& history = *reinterpret_cast<History*>(numbers);
        history.growth = growth;
        loads = contact<Friction, wall>(pair, settings, motion, history, [] { return 1.0; }, NoObserver{});
        growth = history.growth;
      }
  });
}

template <class Law>
__global__ void contacts(int n, const ContactConstants<Law>* pair, ContactSettings settings, bool wall, int friction,
                         const Kinematics<double>* motion, double (*history)[64], ContactLoads<double>* loads) {
  const int k = blockIdx.x * blockDim.x + threadIdx.x;
  if (k >= n) return;
  NoGrowth none;
  if (wall)
    act<true>(*pair, settings, motion[k], friction, history[k], none, loads[k]);
  else
    act<false>(*pair, settings, motion[k], friction, history[k], none, loads[k]);
}

template <class Law>
__global__ void grown_contacts(int n, const ContactConstants<Law>* pair, ContactSettings settings, bool wall,
                               int friction, const Kinematics<double>* motion, Growing<true, double>* at_wall,
                               Growing<false, double>* of_pair, double (*history)[64], ContactLoads<double>* loads) {
  const int k = blockIdx.x * blockDim.x + threadIdx.x;
  if (k >= n) return;
  if (wall)
    act<true>(*pair, settings, motion[k], friction, history[k], at_wall[k], loads[k]);
  else
    act<false>(*pair, settings, motion[k], friction, history[k], of_pair[k], loads[k]);
}

/// A law from its parameters, and a whole impact by velocity Verlet.
template <class Law>
__global__ void impacts(int n, double E_star, const double* parameters, ImpactInput<double> in, double* speeds) {
  const int k = blockIdx.x * blockDim.x + threadIdx.x;
  if (k >= n) return;
  in.speed = speeds[k];
  speeds[k] = impact(law_of<Law>(E_star, parameters, 1.0), in, {}).rebound_speed;
}

#define EPDEM_KERNELS(Class)                                                                                 \
  template __global__ void contacts(int, const ContactConstants<Class<double>>*, ContactSettings, bool, int, \
                                    const Kinematics<double>*, double (*)[64], ContactLoads<double>*);       \
  template __global__ void impacts<Class<double>>(int, double, const double*, ImpactInput<double>, double*);
EPDEM_LAWS(EPDEM_KERNELS)
template __global__ void grown_contacts(int, const ContactConstants<Cavity<double>>*, ContactSettings, bool, int,
                                        const Kinematics<double>*, Growing<true, double>*, Growing<false, double>*,
                                        double (*)[64], ContactLoads<double>*);
