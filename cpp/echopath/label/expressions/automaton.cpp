#include "echopath/label/expressions/automaton.h"

#include <algorithm>
#include <map>
#include <utility>

#include "echopath/base/text/nearest_names.h"
#include "echopath/label/expressions/nfa.h"
#include "echopath/scene/scene.h"

namespace echopath {
namespace {

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

// P{0} names them too: what it is written for goes through none there.
bool names_passes(const Syntax& syntax) {
  if (syntax.kind == Syntax::Kind::kHit) return syntax.hit.event == Event::kPass;
  return std::ranges::any_of(syntax.children, names_passes);
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
          const Nfa::State& reader = nfa_.states[member];
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
      if (std::exchange(seen_[state], visit_) == visit_) continue;
      const Nfa::State& at = nfa_.states[state];
      if (state == 0 || at.pattern >= 0) set.push_back(state);
      else pending.insert(pending.end(), at.next.begin(), at.next.end());
    }
    std::ranges::sort(set);
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
  const Nfa nfa = make_nfa(expression);
  const MeshClasses classes = classify_meshes(nfa, expression, mesh_names);
  num_events_ = names_passes(expression.body) ? kPassSymbol + 1 : kPassSymbol;
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
  std::vector<uint64_t> of_class(num_classes_);
  for (size_t mesh = 0; mesh + 1 < symbols_.size(); ++mesh) of_class[symbols_[mesh + 1] / num_events_] |= mesh_bit(mesh);
  for (uint32_t mesh_class = 0; mesh_class < of_class.size(); ++mesh_class) {
    if (!takes_something_without(mesh_class)) needed_bits_.push_back(of_class[mesh_class]);
  }
}

}  // namespace echopath
