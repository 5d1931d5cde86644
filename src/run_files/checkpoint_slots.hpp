#pragma once

#include "ehdjet/core/checkpoint.hpp"

#include <cstdint>
#include <optional>

#include "hdf5.hpp"

namespace ehdjet::hdf5 {

/// Checkpoints in a run file: the group /checkpoint has two slots, one that is current and one for
/// the next. The space of a slot is used again and again, so that the file does not grow.

/// Writes to the slot that is not current; returns its number.
std::uint64_t fill_free_slot(hid_t file, const Checkpoint& checkpoint);
/// To be called after the slot has been committed to the disk.
void make_current(hid_t file, std::uint64_t slot);

/// None if there is none yet. errors : Failure
std::optional<Checkpoint> read_current_slot(hid_t file);

} // namespace ehdjet::hdf5
