// The entry point of libFuzzer for one target, whose function the build names.
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  echopath::fuzz::ECHOPATH_FUZZ_FEED({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
