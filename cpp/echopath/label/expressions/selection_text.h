#pragma once
// Reads selections from text: path expressions joined by & | ~ and parentheses, as Selection::text writes them.
//
//   selection   := conjunction { '|' conjunction }
//   conjunction := operand { '&' operand }
//   operand     := '~' operand | '(' selection ')' | power | path expression (label/expressions/expression.h), up to its R
//   power       := 'power' ( '<' | '<=' | '>' | '>=' ) number       W, at the trace time for the first antennas
//
// ~ binds tightest, | weakest: T 'walker' R | ~(T . R) & T .* 'wall' .* R. White space may stand between any two symbols.
#include <string_view>

#include "echopath/label/expressions/selection.h"

namespace echopath {

// Parses a selection. Raises invalid_argument whose message says what was expected, with a caret under the fault.
Selection parse_selection(std::string_view text);

}  // namespace echopath
