#pragma once
// Tells which known names are like one that is unknown, for hints in errors.
#include <string>
#include <string_view>
#include <vector>

namespace echopath {

// Returns the candidates most like `word`, at most `count`, for texts such as "did you mean": those that it begins, then
// those that share the most whole parts of a path with it from its beginning (walker/arms: walker/arm_left before
// parker/arms), then by edit distance: between the whole names, or between the last part of the word without its
// wildcards and that of a path, or a word of it, which count for one more (legs: walker/leg_left).
std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& candidates, int count = 3);

}  // namespace echopath
