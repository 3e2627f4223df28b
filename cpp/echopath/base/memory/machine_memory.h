#pragma once
#include <cstdint>

namespace echopath {

// Returns the memory of this machine, in bytes; the largest number where the system does not tell.
int64_t machine_memory();

}  // namespace echopath
