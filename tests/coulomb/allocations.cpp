#include "coulomb/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

// Replaces the global operators of the whole program, by the same calls plus a count. All forms
// that are not here end in one of these.
// NOLINTBEGIN(cppcoreguidelines-no-malloc,misc-new-delete-overloads)
namespace {
std::atomic<std::size_t> count = 0;
} // namespace

void* operator new(std::size_t size) {
  ++count;
  void* p = std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++count;
  const auto a = static_cast<std::size_t>(alignment);
  void* p = std::aligned_alloc(a, (size + a - 1) / a * a);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
// NOLINTEND(cppcoreguidelines-no-malloc,misc-new-delete-overloads)

std::size_t ehdjet::test::allocations() {
  return count;
}
