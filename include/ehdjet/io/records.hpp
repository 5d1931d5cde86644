#pragma once

#include "ehdjet/observers/observer.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <memory>

namespace ehdjet {

// Observers that write a part of a run file each and share its ownership. The part is in the file
// at once, without rows. `interval` is the time between rows [s].

/// A row per time about the jet as a whole, and what `further` has about it.
std::unique_ptr<Observer> record_observables(std::shared_ptr<RunFile> file, double interval,
                                             bool with_coulomb_error = false,
                                             std::shared_ptr<Accounts> further = {});
/// All beads of jets with that table.
std::unique_ptr<Observer> record_frames(std::shared_ptr<RunFile> file, double interval,
                                        const BeadTable& table);
/// A row per bead that leaves the chain.
std::unique_ptr<Observer> record_deposit(std::shared_ptr<RunFile> file,
                                         std::shared_ptr<const BeadTable> table);
/// A row per refinement.
std::unique_ptr<Observer> record_refinements(std::shared_ptr<RunFile> file,
                                             bool with_coulomb_energy);
/// A row of energy and momentum per time.
std::unique_ptr<Observer> record_budget(std::shared_ptr<RunFile> file, double interval,
                                        std::shared_ptr<Accounts> accounts);
/// R = link_length/l along the jet; `link_length`: l_step [m].
std::unique_ptr<Observer> record_resolving_power(std::shared_ptr<RunFile> file,
                                                 double interval, double link_length);
/// The last checkpoint.
std::unique_ptr<Observer> record_checkpoints(std::shared_ptr<RunFile> file);

} // namespace ehdjet
