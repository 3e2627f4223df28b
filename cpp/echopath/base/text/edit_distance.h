#pragma once
#include <string_view>

namespace echopath {

// Returns how many letters must be put in, taken out, replaced or swapped with their neighbour to make one word of the other
// (Damerau; no letter is touched twice).
size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace echopath
