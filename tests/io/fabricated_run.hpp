#pragma once

#include "ehdjet/io/records.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/observers/observer.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/folder.hpp"
#include "support/stress.hpp"

namespace ehdjet::testing {

using test::Folder;

/// A jet that no physics made: any number of beads, different numbers in every place.
struct FabricatedJet {
  double time = 0;
  JetState jet;
  std::vector<double> values; // what the snapshot shows; jet.y holds something else
  Ledger ledger;
  RunStatistics statistics;

  [[nodiscard]] JetSnapshot snapshot() const {
    return {time, JetColumns<const double>{values, jet.beads()}, jet, ledger, statistics};
  }
};

/// Frame k of a run whose chain grows, shrinks, has an embryo now and then and a landed bead.
FabricatedJet fabricated_jet(std::uint64_t k, bool with_stress = true);

/// Checkpoint k of a run whose lists grow and shrink, over several chunks.
Checkpoint fabricated_checkpoint(std::uint64_t k);

Provenance fabricated_provenance();

/// Writes `frames` fabricated frames, a row and a deposited bead with each.
void write_run(const std::filesystem::path& path, std::size_t frames,
               bool with_stress = true);

/// Bead k of the deposit of a fabricated run.
DepositedBead fabricated_deposit(std::uint64_t k);

/// Holds at least `flushed` frames, rows and deposited beads of a fabricated run, each of them
/// whole.
void expect_intact(const RunReader& run, std::uint64_t flushed);

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace ehdjet::testing
