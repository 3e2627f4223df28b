#include "echopath/label/expressions/expression.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace echopath {
namespace {

const std::string kExpectHit = "expected a hit (. 'mesh' S D E P [...])";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_continuation_byte(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }  // UTF-8

class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, size_t at) : text_(text), at_(at) {}

  // Parses from T to R; position() is then behind it.
  Syntax parse() {
    skip_space();
    if (!take('T')) fail("expected T, the transmitter, at the beginning");
    Syntax body;
    if (at_end()) fail(kExpectHit + ", '(' or R, the receiver");
    if (peek() != 'R') body = parse_choice();
    if (peek() != 'R') fail(kExpectHit + ", '(', '|' or R, the receiver");
    ++at_;
    return body;
  }
  void expect_end() {
    skip_space();
    if (!at_end()) fail("expected the end after R, the receiver");
  }
  size_t position() const { return at_; }

 private:
  Syntax parse_choice() {
    Syntax choice{Syntax::Kind::kChoice, {}, {}, 0, 0};
    do {
      choice.children.push_back(parse_sequence());
    } while (take('|'));
    return choice.children.size() == 1 ? std::move(choice.children.front()) : choice;
  }

  Syntax parse_sequence() {
    Syntax sequence;
    do {
      sequence.children.push_back(parse_repeat());
    } while (starts_atom(peek()));
    return sequence.children.size() == 1 ? std::move(sequence.children.front()) : sequence;
  }

  Syntax parse_repeat() {
    Syntax atom = parse_atom();
    Syntax repeat{Syntax::Kind::kRepeat, {}, {}, 0, kNoLimit};
    if (take('+')) {
      repeat.min = 1;
    } else if (take('?')) {
      repeat.max = 1;
    } else if (peek() == '{') {
      parse_count(repeat);
    } else if (!take('*')) {
      return atom;
    }
    if (is_operator(peek())) fail("expected parentheses around a repeat that is repeated, as in (.+){2}");
    repeat.children.push_back(std::move(atom));
    return repeat;
  }

  void parse_count(Syntax& repeat) {
    take('{');
    repeat.min = repeat.max = parse_number("a number");
    if (take(',')) {
      const size_t position = at_;
      repeat.max = peek() == '}' ? kNoLimit : parse_number("a number or '}'");
      if (repeat.max != kNoLimit && repeat.max < repeat.min) fail_at(position, "expected n >= m in {m,n}");
    } else if (peek() != '}') {
      fail("expected ',' or '}'");
    }
    if (!take('}')) fail("expected '}'");
  }

  int parse_number(const std::string& expected) {
    const size_t position = at_;
    if (!is_digit(peek())) fail("expected " + expected);
    int number = 0;
    for (; is_digit(peek()); ++at_) number = std::min(10 * number + (peek() - '0'), kMaxRepeatCount + 1);
    if (number > kMaxRepeatCount) {
      const std::string digits(text_.substr(position, at_ - position));
      throw_expression_error(text_, position,
                             "expected a count of at most " + std::to_string(kMaxRepeatCount) + ", got " + digits);
    }
    skip_space();
    return number;
  }

  Syntax parse_atom() {
    if (is_operator(peek())) fail("expected a hit or ')' before this operator");
    if (!starts_atom(peek())) fail(kExpectHit + " or '('");
    if (peek() != '(') return parse_hit();
    if (++nesting_ > kMaxNesting) fail("expected at most " + std::to_string(kMaxNesting) + " nested parentheses");
    take('(');
    Syntax inner = parse_choice();
    if (!take(')')) fail(kExpectHit + ", '(', '|' or ')'");
    --nesting_;
    return inner;
  }

  Syntax parse_hit() {
    Syntax syntax{Syntax::Kind::kHit, {}, {}, 0, 0};
    if (take('.')) return syntax;
    if (starts_event(peek())) {
      syntax.hit.event = event_of(peek());
      const size_t after = at_ + 1;
      take(peek());
      if (!starts_meshes(peek())) return syntax;
      if (at_ != after) fail("expected no white space here: S'a' is one hit, (S) 'a' is two");
    }
    parse_meshes(syntax.hit);
    return syntax;
  }

  void parse_meshes(HitPattern& hit) {
    if (!take('[')) {
      hit.globs.push_back(parse_glob());
      return;
    }
    hit.negated = take('^');
    do {
      if (peek() != '\'') fail(hit.globs.empty() ? "expected a quoted glob" : "expected a quoted glob or ']'");
      hit.globs.push_back(parse_glob());
    } while (!take(']'));
  }

  HitPattern::Glob parse_glob() {
    const size_t open = at_;
    const size_t close = text_.find('\'', open + 1);
    if (close == std::string_view::npos) fail("expected a closing quote for this one");
    if (close == open + 1) fail("expected a mesh name or glob between the quotes");
    at_ = close + 1;
    skip_space();
    return {std::string(text_.substr(open + 1, close - open - 1)), open};
  }

  static bool starts_meshes(char c) { return c == '\'' || c == '['; }
  static bool starts_atom(char c) { return starts_meshes(c) || c == '.' || starts_event(c) || c == '('; }
  static bool starts_event(char c) { return c == 'S' || c == 'D' || c == 'E' || c == 'P'; }
  static HitPattern::Event event_of(char c) {
    if (c == 'E') return HitPattern::Event::kEdge;
    if (c == 'P') return HitPattern::Event::kPass;
    return c == 'S' ? HitPattern::Event::kSpecular : HitPattern::Event::kDiffuse;
  }
  static bool is_operator(char c) { return c == '*' || c == '+' || c == '?' || c == '{'; }

  bool at_end() const { return at_ >= text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  void skip_space() {
    while (!at_end() && is_expression_space(text_[at_])) ++at_;
  }
  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    skip_space();
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const { fail_at(at_, what); }
  [[noreturn]] void fail_at(size_t position, const std::string& what) const {
    throw_expression_error(text_, position, what + ", got " + found_in_expression(text_, position));
  }

  std::string_view text_;
  size_t at_;
  int nesting_ = 0;
};

// Moves the positions of globs to a text that begins at byte `begin` of the one that was read.
void move_globs(Syntax& syntax, size_t begin) {
  for (HitPattern::Glob& glob : syntax.hit.globs) glob.position -= begin;
  for (Syntax& child : syntax.children) move_globs(child, begin);
}

}  // namespace

PathExpression parse_path_expression(std::string_view text) {
  ExpressionParser parser(text, 0);
  Syntax body = parser.parse();
  parser.expect_end();
  return {std::string(text), std::move(body)};
}

PathExpression read_path_expression(std::string_view text, size_t& position) {
  const size_t begin = position;
  ExpressionParser parser(text, begin);
  Syntax body = parser.parse();
  position = parser.position();
  move_globs(body, begin);
  return {std::string(text.substr(begin, position - begin)), std::move(body)};
}

bool is_expression_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string found_in_expression(std::string_view text, size_t position, size_t length) {
  if (position >= text.size()) return "the end";
  size_t end = std::min(position + length, text.size());
  while (end < text.size() && is_continuation_byte(text[end])) ++end;
  return std::string(text.substr(position, end - position));
}

void throw_expression_error(std::string_view text, size_t position, std::string_view what) {
  const size_t before = position == 0 ? std::string_view::npos : text.find_last_of('\n', position - 1);
  const size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
  std::string indent;  // tabs stay tabs, so that the caret stands under the fault on any screen
  for (const char c : line.substr(0, position - begin)) {
    if (!is_continuation_byte(c)) indent += c == '\t' ? '\t' : ' ';
  }
  std::string message = "path expression: ";
  message.append(what).append("\n  ").append(line).append("\n  ").append(indent).append("^");
  throw std::invalid_argument(message);
}

}  // namespace echopath
