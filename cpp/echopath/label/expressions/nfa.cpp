#include "echopath/label/expressions/nfa.h"

#include <map>
#include <stdexcept>
#include <utility>

#include "echopath/label/expressions/automaton.h"

namespace echopath {

void throw_too_large(const std::string& text) {
  constexpr size_t kShown = 80;  // bytes of a text that may name thousands of meshes
  const std::string shown = found_in_expression(text, 0, kShown);
  throw std::invalid_argument("path expression: must compile to at most " + std::to_string(kMaxAutomatonStates) +
                              " states; use smaller counts or split it, got " + shown +
                              (shown.size() < text.size() ? "..." : ""));
}

namespace {

constexpr int kMaxPositions = 8192;  // states before determinisation; bounds the time to compile

class NfaBuilder {
 public:
  explicit NfaBuilder(const PathExpression& expression) : text_(expression.text) {
    nfa_.states.emplace_back();
    nfa_.start = build(expression.body, 0);
  }
  Nfa take() { return std::move(nfa_); }

 private:
  // Returns the state from which `syntax`, and then what follows `next`, is read.
  int build(const Syntax& syntax, int next) {
    switch (syntax.kind) {
      case Syntax::Kind::kHit: return add({pattern_index(syntax.hit), {next}});
      case Syntax::Kind::kSequence:
        for (size_t i = syntax.children.size(); i-- > 0;) next = build(syntax.children[i], next);
        return next;
      case Syntax::Kind::kChoice: return build_choice(syntax, next);
      case Syntax::Kind::kRepeat: return build_repeat(syntax, next);
    }
    return next;
  }

  int build_choice(const Syntax& choice, int next) {
    std::vector<int> branches;
    for (const Syntax& child : choice.children) branches.push_back(build(child, next));
    return add({-1, std::move(branches)});
  }

  int build_repeat(const Syntax& repeat, int next) {
    const Syntax& child = repeat.children.front();
    if (repeat.max == kNoLimit) {
      const int loop = add({-1, {next}});
      const int again = build(child, loop);
      nfa_.states[loop].next.push_back(again);
      next = loop;
    }
    const int end = next;
    for (int i = repeat.min; i < repeat.max; ++i) next = add({-1, {build(child, next), end}});
    for (int i = 0; i < repeat.min; ++i) {
      const int start = build(child, next);
      if (start == next) break;  // the child reads nothing; nested counts of nothing would take for ever
      next = start;
    }
    return next;
  }

  int add(Nfa::State state) {
    if (nfa_.states.size() >= kMaxPositions) throw_too_large(text_);
    nfa_.states.push_back(std::move(state));
    return static_cast<int>(nfa_.states.size()) - 1;
  }

  int pattern_index(const HitPattern& pattern) {
    const auto [entry, added] = index_of_.try_emplace(&pattern, static_cast<int>(nfa_.patterns.size()));
    if (added) nfa_.patterns.push_back(&pattern);
    return entry->second;
  }

  const std::string& text_;
  Nfa nfa_;
  std::map<const HitPattern*, int> index_of_;  // a repeated pattern is one pattern
};

}  // namespace

Nfa make_nfa(const PathExpression& expression) { return NfaBuilder(expression).take(); }

}  // namespace echopath
