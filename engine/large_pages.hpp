#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace jostle::inline engine {

/// Memory in whole cache lines and, where it is much, on large pages if the system has them:
/// random accesses to a million spheres then need no walk through the page tables.
template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}

  T* allocate(std::size_t n) {
    const std::size_t alignment = n * sizeof(T) >= page ? page : line;
    const std::size_t bytes = (n * sizeof(T) + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, bytes);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE) && !defined(JOSTLE_PORTABLE)
    if (alignment == page)
      madvise(memory, bytes, MADV_HUGEPAGE);  // advice: refusal is not an error
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) {
    std::free(memory);
  }

  bool operator==(const LargePageAllocator&) const = default;

 private:
  static constexpr std::size_t line = 64, page = std::size_t{2} << 20;
};

}  // namespace jostle::inline engine
