// SPDX-License-Identifier: GPL-2.0-or-later
// libFuzzer on the C interface: any bytes are the numbers of a call. scripts/fuzz builds it with clang's sanitizers.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "epdem.h"

namespace {

/// Takes numbers off the bytes; zeros after their end.
class Source {
 public:
  Source(const uint8_t* data, size_t size) : data_(data), size_(size) {}

  template <class T>
  T take() {
    T value{};
    const size_t n = sizeof(T) < size_ ? sizeof(T) : size_;
    std::memcpy(&value, data_, n);
    data_ += n, size_ -= n;
    return value;
  }
  std::vector<double> doubles(size_t n) {
    std::vector<double> found(n);
    for (double& x : found) x = take<double>();
    return found;
  }

 private:
  const uint8_t* data_;
  size_t size_;
};

bool within(double x, double low, double high) { return x >= low && x <= high; }

void must(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Source source(data, size);
  const int law = source.take<uint8_t>() % 16 - 4;  // some that do not exist, on both sides
  const size_t n = source.take<uint8_t>() % 4;
  const double E_star = source.take<double>(), R_star = source.take<double>();
  const std::vector<double> parameters = source.doubles(EPDEM_MAX_PARAMETERS);
  const std::vector<double> radii(n, R_star), largest = source.doubles(n), delta = source.doubles(n);
  std::vector<epdem_step_result> out(n);
  const int status =
      epdem_step(law, E_star, parameters.data(), n, radii.data(), largest.data(), delta.data(), out.data());
  must(status >= EPDEM_OK && status <= EPDEM_BAD_INPUT && epdem_message(status) != nullptr);
  bool usual = within(E_star, 1e-9, 1e30) && within(R_star, 1e-12, 1e6);
  for (double x : parameters) usual = usual && within(x, 1e-9, 1e30);
  for (size_t k = 0; k < n; ++k) usual = usual && within(largest[k], 0, R_star) && within(delta[k], -R_star, R_star);
  const bool pulls = epdem_law_adheres(law) > 0;
  for (size_t k = 0; usual && status == EPDEM_OK && k < n; ++k)
    must(std::isfinite(out[k].force) && (pulls || out[k].force >= 0) && out[k].radius >= 0);
  std::vector<double> column[4];
  for (auto& c : column) c.resize(n);
  epdem_backbone(law, E_star, parameters.data(), n, radii.data(), delta.data(), column[0].data(), column[1].data(),
                 column[2].data(), column[3].data());
  std::vector<epdem_impact_input> in(n);
  const int64_t steps = source.take<uint8_t>();
  for (auto& i : in) {
    i = {source.take<double>(), source.take<double>(), source.take<double>(),
         source.take<double>(), source.take<double>(), steps,
         source.take<double>()};
  }
  std::vector<epdem_impact_output> impacts(n);
  std::vector<double> samples(n * static_cast<size_t>(steps + 1));
  epdem_impacts(law, E_star, parameters.data(), n, in.data(), impacts.data(), static_cast<size_t>(steps + 1),
                samples.data(), nullptr, nullptr);
  epdem_viscous_number(E_star);
  epdem_law_name(law), epdem_law_parameter_default(law, static_cast<int>(n));
  return 0;
}
