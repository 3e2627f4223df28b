#pragma once
// Makes nondeterministic automata of path expressions.
#include <string>
#include <vector>

#include "echopath/label/expressions/expression.h"

namespace echopath {

// A nondeterministic automaton (Thompson 1968), in which a state either reads one hit or branches without reading.
struct Nfa {
  struct State {
    int pattern = -1;       // index into `patterns`; -1: a branch
    std::vector<int> next;  // one state after a hit, any number for a branch
  };
  std::vector<State> states;  // state 0 takes the path; it has no next
  std::vector<const HitPattern*> patterns;
  int start = 0;
};

// Builds the automaton of an expression, which must outlive it. Raises invalid_argument where it is too large.
Nfa make_nfa(const PathExpression& expression);

// Raises invalid_argument: the expression of this text needs more states than kMaxAutomatonStates.
[[noreturn]] void throw_too_large(const std::string& text);

}  // namespace echopath
