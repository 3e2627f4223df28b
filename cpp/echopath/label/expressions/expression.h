#pragma once
// Parses path expressions: regular expressions over the hits of a path, from the transmitter T to the receiver R.
//
//   expression := 'T' [ choice ] 'R'             'T R' takes the path without hits
//   choice     := sequence { '|' sequence }
//   sequence   := repeat { repeat }              never empty
//   repeat     := atom [ '*' | '+' | '?' | '{' m '}' | '{' m ',' '}' | '{' m ',' n '}' ]
//   atom       := hit | '(' choice ')'
//   hit        := '.' | event | [ event ] meshes
//   event      := 'S' | 'D' | 'E' | 'P'    specular or diffuse: the bit in Paths::diffuse; on an edge: edge_hit; a pass
//   meshes     := glob | '[' [ '^' ] glob { glob } ']'
//   glob       := "'" characters other than "'" "'"
//
// Passes through sheets (Paths::passes) are hits only to an expression that names the event P anywhere; then . and a glob or
// set without an event take them, too. To all others they do not exist: the echo of what stands behind a pane is T . R.
// The whole path must match. T and R bind weakest: T 'a' | 'b' R is T ('a' | 'b') R. Counts m <= n are at most
// kMaxRepeatCount; a repeat of a repeat needs parentheses. White space may stand between any two symbols and means
// nothing, with one exception: between an event and a glob or set it is an error, as S'a' is one hit and (S) 'a' two.
// A set takes a hit on a mesh that one of its globs takes (scene.h: glob_takes), [^ ...] one that none of them takes.
// After the light path expressions of Heckbert ("Adaptive radiosity textures for bidirectional ray tracing", 1990).
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace echopath {

constexpr int kMaxRepeatCount = 64;  // the longest path that a trace makes
constexpr int kMaxNesting = 100;  // of parentheses and ~; bounds the recursion of parsers, of the compiler and of Selection
constexpr int kNoLimit = -1;

// Describes what one hit must be.
struct HitPattern {
  enum class Event { kAny, kSpecular, kDiffuse, kEdge, kPass };
  struct Glob {
    std::string text;
    size_t position;  // of its opening quote in the expression, bytes
  };
  Event event = Event::kAny;
  bool negated = false;     // takes the meshes that no glob takes
  std::vector<Glob> globs;  // empty: every mesh
};

// Holds the syntax tree of a path expression without its T and R.
struct Syntax {
  enum class Kind { kHit, kSequence, kChoice, kRepeat };
  Kind kind = Kind::kSequence;   // a sequence without children takes no hit at all
  HitPattern hit;                // kHit
  std::vector<Syntax> children;  // kSequence, kChoice: any number; kRepeat: one
  int min = 0, max = 0;          // kRepeat; max may be kNoLimit
};

struct PathExpression {
  std::string text;  // as given
  Syntax body;
};

// Parses a path expression. Raises invalid_argument whose message says what was expected, with a caret under the fault.
PathExpression parse_path_expression(std::string_view text);

// Parses an expression that begins at byte `position` of a longer text, and moves `position` behind its R. The caret stands
// in the whole text.
PathExpression read_path_expression(std::string_view text, size_t& position);

// Raises invalid_argument("path expression: <what>") followed by the line of `text` that holds byte `position` and a
// caret under it.
[[noreturn]] void throw_expression_error(std::string_view text, size_t position, std::string_view what);

// Returns what stands at `position`, for such a message: whole characters of `length` bytes or more, or "the end".
std::string found_in_expression(std::string_view text, size_t position, size_t length = 1);

bool is_expression_space(char c);

}  // namespace echopath
