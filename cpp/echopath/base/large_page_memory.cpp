#include "echopath/base/large_page_memory.h"

#include <algorithm>
#include <new>

#include "echopath/base/large_array.h"

namespace echopath {
namespace {

constexpr size_t kLargePage = size_t{1} << 21;

std::align_val_t chunk_alignment(size_t alignment) { return std::align_val_t{std::max(alignment, kLargePage)}; }

}  // namespace

void* LargePageMemory::Chunks::do_allocate(size_t num_bytes, size_t alignment) {
  void* data = ::operator new(num_bytes, chunk_alignment(alignment));
  prefer_large_pages(data, num_bytes);
  return data;
}

void LargePageMemory::Chunks::do_deallocate(void* data, size_t num_bytes, size_t alignment) {
  ::operator delete(data, num_bytes, chunk_alignment(alignment));
}

void* LargePageMemory::do_allocate(size_t num_bytes, size_t alignment) {
  const std::lock_guard lock(mutex_);
  return pieces_.allocate(num_bytes, alignment);
}

}  // namespace echopath
