#include "echopath/label/expressions/automaton.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/base/simd.h"
#include "echopath/scene/scene.h"

namespace echopath {
namespace {

constexpr int kMaxPositions = 8192;                 // states before determinisation; bounds the time to compile
constexpr int64_t kPathsMatchedTogether = 1 << 14;  // 0.2 ms of work at most

uint64_t mesh_bit(size_t mesh_id) { return uint64_t{1} << (mesh_id % 64); }

// Calls body(begin, end) for ranges of all paths, on all threads.
void for_paths(const Paths& paths, Job* job, const std::function<void(size_t begin, size_t end)>& body) {
  parallel_for((paths.num_paths() + kPathsMatchedTogether - 1) / kPathsMatchedTogether, [&](int64_t task) {
    const int64_t end = std::min((task + 1) * kPathsMatchedTogether, paths.num_paths());
    body(static_cast<size_t>(task * kPathsMatchedTogether), static_cast<size_t>(end));
  }, job);
}

ECHOPATH_INLINE void keep_touching(const uint64_t* bits, uint64_t needed, size_t count, uint8_t* candidates) {
  for (size_t i = 0; i < count; ++i) candidates[i] &= static_cast<uint8_t>((bits[i] & needed) != 0);
}

[[noreturn]] void throw_too_large(const std::string& text) {
  throw std::invalid_argument("path expression: must compile to at most " + std::to_string(kMaxAutomatonStates) +
                              " states; use smaller counts or split it, got " + text);
}

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
      nfa_.states[static_cast<size_t>(loop)].next.push_back(again);
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

[[noreturn]] void throw_takes_no_mesh(const PathExpression& expression, const HitPattern::Glob& glob,
                                      const std::vector<std::string>& mesh_names) {
  std::string what = "expected a glob that takes a mesh, got '" + glob.text + "'; ";
  if (mesh_names.empty()) what += "the scene has no meshes";
  const std::vector<std::string> nearest = nearest_names(glob.text, names_with_ancestors(mesh_names));
  for (size_t i = 0; i < nearest.size(); ++i) what += (i == 0 ? "nearest names: " : ", ") + nearest[i];
  throw_expression_error(expression.text, glob.position, what);
}

// Returns [M] whether the pattern takes a hit on each mesh, whatever its event.
std::vector<bool> meshes_of(const HitPattern& pattern, const PathExpression& expression,
                            const std::vector<std::string>& mesh_names) {
  std::vector<bool> taken(mesh_names.size(), pattern.globs.empty());
  for (const HitPattern::Glob& glob : pattern.globs) {
    bool takes_any = false;
    for (size_t mesh = 0; mesh < mesh_names.size(); ++mesh) {
      if (!glob_takes(glob.text, mesh_names[mesh])) continue;
      taken[mesh] = takes_any = true;
    }
    if (!takes_any) throw_takes_no_mesh(expression, glob, mesh_names);
  }
  if (pattern.negated) taken.flip();
  return taken;
}

struct MeshClasses {
  std::vector<uint32_t> class_of_mesh;      // [M]
  std::vector<std::vector<bool>> taken_by;  // [class][pattern]
};

MeshClasses classify_meshes(const Nfa& nfa, const PathExpression& expression, const std::vector<std::string>& mesh_names) {
  std::vector<std::vector<bool>> meshes;  // [pattern][M]
  for (const HitPattern* pattern : nfa.patterns) meshes.push_back(meshes_of(*pattern, expression, mesh_names));
  MeshClasses classes;
  std::map<std::vector<bool>, uint32_t> index_of;
  for (size_t mesh = 0; mesh < mesh_names.size(); ++mesh) {
    std::vector<bool> taken_by(meshes.size());
    for (size_t pattern = 0; pattern < meshes.size(); ++pattern) taken_by[pattern] = meshes[pattern][mesh];
    const auto [entry, added] = index_of.try_emplace(taken_by, static_cast<uint32_t>(index_of.size()));
    if (added) classes.taken_by.push_back(taken_by);
    classes.class_of_mesh.push_back(entry->second);
  }
  return classes;
}

using Event = HitPattern::Event;
constexpr Event kEventOfSymbol[] = {Event::kSpecular, Event::kDiffuse, Event::kEdge, Event::kPass};

bool takes_event(const HitPattern& pattern, Event event) { return pattern.event == Event::kAny || pattern.event == event; }

bool names_passes(const Nfa& nfa) {
  return std::any_of(nfa.patterns.begin(), nfa.patterns.end(),
                     [](const HitPattern* pattern) { return pattern->event == Event::kPass; });
}

// Makes the automaton deterministic by subset construction (Rabin and Scott 1959).
class Determiniser {
 public:
  Determiniser(const Nfa& nfa, const MeshClasses& classes, uint32_t num_events, const std::string& text)
      : nfa_(nfa), classes_(classes), events_(kEventOfSymbol, num_events), text_(text), seen_(nfa.states.size(), 0) {
    index_of({nfa.start});
    for (size_t state = 0; state < sets_.size(); ++state) expand(state);
  }
  size_t num_states() const { return sets_.size(); }
  // [num_states, num_symbols] index of the next state
  const std::vector<uint32_t>& next() const { return next_; }
  bool accepts(size_t state) const { return sets_[state]->first.front() == 0; }

 private:
  using StateSet = std::vector<int>;  // ascending, without branches; {-1} where nothing more can match

  void expand(size_t state) {
    const StateSet& set = sets_[state]->first;
    for (const std::vector<bool>& taken_by : classes_.taken_by) {
      for (const Event event : events_) {
        StateSet reached;
        for (const int member : set) {
          if (member <= 0) continue;
          const Nfa::State& reader = nfa_.states[static_cast<size_t>(member)];
          const auto pattern = static_cast<size_t>(reader.pattern);
          const bool taken = taken_by[pattern] && takes_event(*nfa_.patterns[pattern], event);
          if (taken) reached.push_back(reader.next.front());
        }
        next_.push_back(index_of(reached));
      }
    }
  }

  uint32_t index_of(const StateSet& reached) {
    const auto [entry, added] = index_of_.try_emplace(closure(reached), static_cast<uint32_t>(sets_.size()));
    if (added) {
      if (sets_.size() >= kMaxAutomatonStates) throw_too_large(text_);
      sets_.push_back(&*entry);
    }
    return entry->second;
  }

  // Returns the reading and accepting states that branches lead to.
  StateSet closure(StateSet pending) {
    ++visit_;
    StateSet set;
    while (!pending.empty()) {
      const int state = pending.back();
      pending.pop_back();
      if (std::exchange(seen_[static_cast<size_t>(state)], visit_) == visit_) continue;
      const Nfa::State& at = nfa_.states[static_cast<size_t>(state)];
      if (state == 0 || at.pattern >= 0) set.push_back(state);
      else pending.insert(pending.end(), at.next.begin(), at.next.end());
    }
    std::sort(set.begin(), set.end());
    if (set.empty()) set.push_back(-1);
    return set;
  }

  const Nfa& nfa_;
  const MeshClasses& classes_;
  std::span<const Event> events_;
  const std::string& text_;
  std::vector<int64_t> seen_;  // last visit of each state
  int64_t visit_ = 0;
  std::map<StateSet, uint32_t> index_of_;
  std::vector<const std::pair<const StateSet, uint32_t>*> sets_;  // nodes of a map stay where they are
  std::vector<uint32_t> next_;
};

}  // namespace

Automaton::Automaton(const PathExpression& expression, const std::vector<std::string>& mesh_names) {
  const Nfa nfa = NfaBuilder(expression).take();
  const MeshClasses classes = classify_meshes(nfa, expression, mesh_names);
  num_events_ = names_passes(nfa) ? kPassSymbol + 1 : kPassSymbol;
  const Determiniser dfa(nfa, classes, num_events_, expression.text);
  num_states_ = static_cast<int>(dfa.num_states());
  num_classes_ = static_cast<int>(classes.taken_by.size());

  const size_t num_symbols = num_events_ * classes.taken_by.size();
  const size_t stride = num_symbols + 2;
  accept_column_ = static_cast<uint32_t>(num_symbols) + 1;
  symbols_.push_back(static_cast<uint32_t>(num_symbols));
  for (const uint32_t mesh_class : classes.class_of_mesh) symbols_.push_back(num_events_ * mesh_class);
  for (size_t state = 0; state < dfa.num_states(); ++state) {
    for (size_t symbol = 0; symbol < num_symbols; ++symbol) {
      table_.push_back(static_cast<uint32_t>(dfa.next()[state * num_symbols + symbol] * stride));
    }
    table_.push_back(static_cast<uint32_t>(state * stride));
    table_.push_back(dfa.accepts(state) ? 1 : 0);
  }
  find_needed_bits();
}

bool Automaton::takes_with_passes(const Hit* hits, int num_hits, uint64_t diffuse, int first_edge, int end_edge,
                                  std::span<const Pass> passes) const {
  uint32_t row = 0;
  size_t next = 0;
  const auto read = [&](uint32_t mesh_id, uint32_t event) { row = table_[row + symbols_[mesh_id + 1] + event]; };
  for (int k = 0; k <= num_hits; ++k) {
    for (; next < passes.size() && passes[next].leg == static_cast<uint32_t>(k); ++next) {
      read(passes[next].hit.mesh_id, kPassSymbol);
    }
    const bool is_edge = k >= first_edge && k < end_edge;
    if (k < num_hits) read(hits[k].mesh_id, is_edge ? kEdgeSymbol : static_cast<uint32_t>(diffuse >> k & 1u));
  }
  return table_[row + accept_column_] != 0;
}

// Walks from the start; states are named by the beginnings of their rows.
bool Automaton::takes_something_without(uint32_t mesh_class) const {
  std::vector<uint8_t> was_seen(table_.size());
  std::vector<uint32_t> pending = {0};
  while (!pending.empty()) {
    const uint32_t row = pending.back();
    pending.pop_back();
    if (std::exchange(was_seen[row], uint8_t{1}) != 0) continue;
    if (table_[row + accept_column_] != 0) return true;
    for (uint32_t symbol = 0; symbol + 1 < accept_column_; ++symbol) {
      if (symbol / num_events_ != mesh_class) pending.push_back(table_[row + symbol]);
    }
  }
  return false;
}

void Automaton::find_needed_bits() {
  std::vector<uint64_t> of_class(static_cast<size_t>(num_classes_));
  for (size_t mesh = 0; mesh + 1 < symbols_.size(); ++mesh) of_class[symbols_[mesh + 1] / num_events_] |= mesh_bit(mesh);
  for (uint32_t mesh_class = 0; mesh_class < of_class.size(); ++mesh_class) {
    if (!takes_something_without(mesh_class)) needed_bits_.push_back(of_class[mesh_class]);
  }
}

std::vector<uint64_t> mesh_bits(const Paths& paths, Job* job) {
  std::vector<uint64_t> bits(static_cast<size_t>(paths.num_paths()));
  for_paths(paths, job, [&](size_t begin, size_t end) {
    for (size_t path = begin; path < end; ++path) {
      const Hit* hits = paths.hits_of(static_cast<int64_t>(path));
      for (int k = 0; k < paths.num_bounces[path]; ++k) bits[path] |= mesh_bit(hits[k].mesh_id);
      for (const Pass& pass : paths.passes_of(path)) bits[path] |= mesh_bit(pass.hit.mesh_id);
    }
  });
  return bits;
}

namespace {

constexpr size_t kWord = sizeof(uint64_t);

// Returns the first path from `path` on in whose word of candidates not all are zero; often most paths are no candidates.
size_t next_candidate(const std::vector<uint8_t>& candidates, size_t path, size_t end) {
  for (; path + kWord <= end; path += kWord) {
    uint64_t word;
    std::memcpy(&word, candidates.data() + path, kWord);
    if (word != 0) break;
  }
  return path;
}

}  // namespace

std::vector<uint8_t> matches(const Automaton& automaton, const Paths& paths, Job* job) {
  std::vector<uint8_t> taken(static_cast<size_t>(paths.num_paths()), 1);
  narrow(automaton, paths, taken, job);
  return taken;
}

void narrow(const Automaton& automaton, const Paths& paths, std::vector<uint8_t>& candidates, Job* job,
            const std::vector<uint64_t>& bits) {
  const Hit* hits = paths.hits ? paths.hits->data() : nullptr;
  for_paths(paths, job, [&](size_t begin, size_t end) {
    for (const uint64_t needed : automaton.needed_bits()) {
      if (!bits.empty()) run_simd<keep_touching>(bits.data() + begin, needed, end - begin, candidates.data() + begin);
    }
    for (size_t path = begin; path < end; ++path) {
      if (path % kWord == 0) path = next_candidate(candidates, path, end);
      if (path == end || !candidates[path]) continue;
      const int64_t first = paths.offsets[path];
      const int num_hits = paths.num_bounces[path];
      const int edge = paths.frame.edges ? edge_hit(paths.flags[path]) : -1;
      const int edges_end = edge < 0 ? -1 : edge + num_edge_hits(paths.flags[path]);
      if (const auto passes = paths.passes_of(path); automaton.sees_passes() && !passes.empty()) {
        candidates[path] = automaton.takes_with_passes(hits + first, num_hits, paths.diffuse[path], edge, edges_end, passes);
        continue;
      }
      if (edge >= 0) {
        candidates[path] = automaton.takes_with_edges(hits + first, num_hits, edge, edges_end);
        continue;
      }
      candidates[path] = first + num_hits + Automaton::kOverread <= paths.num_hits()
                             ? automaton.takes_in_fours(hits + first, num_hits, paths.diffuse[path])
                             : automaton.takes(hits + first, num_hits, paths.diffuse[path]);
    }
  });
}

}  // namespace echopath
