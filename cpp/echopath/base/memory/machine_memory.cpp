#include "echopath/base/memory/machine_memory.h"

#include <limits>

#ifdef __unix__
#include <unistd.h>
#endif

namespace echopath {

int64_t machine_memory() {
#ifdef __unix__
  const int64_t pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  if (pages > 0 && page > 0) return pages * page;
#endif
  return std::numeric_limits<int64_t>::max();
}

}  // namespace echopath
