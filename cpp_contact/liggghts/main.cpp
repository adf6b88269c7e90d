// SPDX-License-Identifier: GPL-2.0-or-later
// epdem-liggghts: LIGGGHTS with epdem's models, nothing to preload. Arguments and exit codes are the same as in
// liggghts.
#include <mpi.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "input.h"
#include "lammps.h"
#include "signal_handling.h"
#include "universe.h"

namespace {

/// LIGGGHTS ends a run in good order on these, as its own main program does.
void handle_signals() {
  std::signal(SIGINT, LAMMPS_NS::SignalHandler::int_handler);
  std::signal(SIGTERM, LAMMPS_NS::SignalHandler::int_handler);
  std::signal(SIGUSR1, LAMMPS_NS::SignalHandler::usr1_handler);
}

}  // namespace

int main(int argc, char** argv) {
  // Outside mpirun Open MPI forks a daemon and probes networks: 0.3 s that one process has no use for.
  if (!std::getenv("OMPI_COMM_WORLD_SIZE")) {
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    setenv("OMPI_MCA_pml", "ob1", 0);
    // processes that start and end at the same time would race for one directory in /tmp, and one of them would die
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  }
  // error->one ends in MPI_Abort without flushing: on a pipe or in a file the message would be lost
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  MPI_Init(&argc, &argv);
  handle_signals();
  {
    LAMMPS_NS::LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    // after every fifth error LIGGGHTS prints a tip from memory that it has freed, if its version has this word
    if (char* edition = std::strstr(lammps.universe->version, "PUBLIC")) *edition = 'p';
    lammps.input->file();
  }
  MPI_Finalize();
  return 0;
}
