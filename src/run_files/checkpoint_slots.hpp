#pragma once

#include "ehdjet/core/checkpoint.hpp"

#include <cstdint>
#include <optional>

#include "hdf5.hpp"

/// Checkpoints in a run file. The group /checkpoint has two slots: one is current, the other takes
/// the next checkpoint. The slots are reused, so that the file does not grow.
namespace ehdjet::hdf5 {

/// Writes to the slot that is not current and returns its number.
std::uint64_t fill_free_slot(hid_t file, const Checkpoint& checkpoint);
/// Must be called after the slot has been committed to the disk.
void make_current(hid_t file, std::uint64_t slot);

/// Empty if there is no checkpoint yet. errors : Failure
std::optional<Checkpoint> read_current_slot(hid_t file);

} // namespace ehdjet::hdf5
