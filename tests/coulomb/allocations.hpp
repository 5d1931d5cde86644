#pragma once

#include <cstddef>

namespace ehdjet::test {

/// Calls of any operator new in this program so far.
std::size_t allocations();

} // namespace ehdjet::test
