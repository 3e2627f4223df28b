#pragma once
// Tells which name somebody meant who wrote another one, for hints in errors.
#include <string>
#include <string_view>
#include <vector>

namespace echopath {

// Returns the one of the `known` names that was most likely meant by `word`: what other programs and books call by that word
// (velocity: speed, pfa: false_alarm_rate), a name that is spelt nearly so, or one that has the word among its own (rays:
// num_rays). Returns "" where none is alike: a hint that is wrong costs more than none.
std::string meant_name(std::string_view word, const std::vector<std::string>& known);

}  // namespace echopath
