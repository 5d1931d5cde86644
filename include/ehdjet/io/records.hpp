#pragma once

#include "ehdjet/observers/array_observer.hpp"
#include "ehdjet/observers/observer.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <memory>

/// Each function returns an observer that writes one part of a run file and shares the ownership
/// of the file. The part is created at once, without rows. `interval` is the time between rows [s].
namespace ehdjet {

/// What observables have that not every run has.
struct FurtherObservables {
  bool coulomb_error = false;
  bool two_rates = false;
  std::shared_ptr<Accounts> accounts = {}; ///< none if null
};
/// Observables of the whole jet, one row per time.
std::unique_ptr<Observer> record_observables(std::shared_ptr<RunFile> file, double interval,
                                             const FurtherObservables& further = {});
/// All beads of jets that have this table of columns.
std::unique_ptr<Observer> record_frames(std::shared_ptr<RunFile> file, double interval,
                                        const BeadTable& table);
/// One row per bead that leaves the chain.
std::unique_ptr<Observer> record_deposit(std::shared_ptr<RunFile> file,
                                         std::shared_ptr<const BeadTable> table);
/// One row per refinement.
std::unique_ptr<Observer> record_refinements(std::shared_ptr<RunFile> file,
                                             bool with_coulomb_energy);
/// Energy and momentum, one row per time.
std::unique_ptr<Observer> record_budget(std::shared_ptr<RunFile> file, double interval,
                                        const std::shared_ptr<Accounts>& accounts);
/// The resolving power R = link_length/l along the jet, where `link_length` is l_step [m].
std::unique_ptr<Observer> record_resolving_power(std::shared_ptr<RunFile> file,
                                                 double interval, double link_length);
/// The last checkpoint.
std::unique_ptr<Observer> record_checkpoints(std::shared_ptr<RunFile> file);

/// The same parts of a run with an array of jets. Beads, deposited beads and refinements have a column
/// `jet`; a row of observables has sums, means and largest values over the jets.
std::unique_ptr<ArrayObserver> record_array_observables(std::shared_ptr<RunFile> file,
                                                        double interval,
                                                        bool coulomb_error);
std::unique_ptr<ArrayObserver> record_array_frames(std::shared_ptr<RunFile> file,
                                                   double interval, const BeadTable& table);
std::unique_ptr<ArrayObserver> record_array_deposit(std::shared_ptr<RunFile> file,
                                                    std::shared_ptr<const BeadTable> table);
std::unique_ptr<ArrayObserver> record_array_refinements(std::shared_ptr<RunFile> file);
std::unique_ptr<ArrayObserver> record_array_checkpoints(std::shared_ptr<RunFile> file);

} // namespace ehdjet
