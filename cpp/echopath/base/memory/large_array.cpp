#include "echopath/base/memory/large_array.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace echopath {

void prefer_large_pages([[maybe_unused]] void* data, [[maybe_unused]] size_t num_bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr uintptr_t kLargePage = uintptr_t{1} << 21;
  const uintptr_t address = reinterpret_cast<uintptr_t>(data);
  if (num_bytes < kLargePage / 4) return;
  // Whole pages, with what lies beside the array in the first and the last one.
  const uintptr_t begin = address & ~(kLargePage - 1), end = (address + num_bytes + kLargePage - 1) & ~(kLargePage - 1);
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // a wish: may fail
#endif
}

}  // namespace echopath
