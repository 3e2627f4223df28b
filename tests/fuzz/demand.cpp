#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.h"

namespace echopath::fuzz {

void demand(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "a reader broke its promise: %s\n", what.c_str());
  std::abort();
}

}  // namespace echopath::fuzz
