#pragma once
// A path expression compiled for one scene: a deterministic automaton that reads one table entry per hit.
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/label/expression.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

constexpr int kMaxAutomatonStates = 4096;

// The symbols are (mesh class, diffuse bit): meshes that every glob or set of the expression treats alike share a
// class.
class Automaton {
 public:
  // mesh_names: full names by mesh ID. Raises invalid_argument when a glob takes no mesh (naming the nearest names) or
  // when more than kMaxAutomatonStates states are needed.
  Automaton(const PathExpression& expression, const std::vector<std::string>& mesh_names);

  // Every path that is taken has one of the bits (mesh_bits) of each of these: meshes without which the expression takes nothing.
  const std::vector<uint64_t>& needed_bits() const { return needed_bits_; }
  int num_states() const { return num_states_; }
  int num_classes() const { return num_classes_; }

  // Whether the expression takes the path with these hits; bit k of `diffuse` tells hit k.
  // Every mesh_id must be below the number of meshes.
  bool takes(const Hit* hits, int num_hits, uint64_t diffuse) const {
    uint32_t row = 0;
    for (int k = 0; k < num_hits; ++k, diffuse >>= 1) {
      row = table_[row + symbols_[hits[k].mesh_id + 1] + static_cast<uint32_t>(diffuse & 1u)];
    }
    return table_[row + accept_column_] != 0;
  }

  // The same and faster, but may read up to kOverread hits beyond the path's own, which must be there. Steps come in
  // fours, those past the end with the symbol that changes nothing: most paths have one to four hits, and a branch on
  // the exact number would be mispredicted so often that it costs more than the steps.
  static constexpr int kOverread = 4;
  bool takes_in_fours(const Hit* hits, int num_hits, uint64_t diffuse) const {
    if (num_hits == 1) return takes(hits, 1, diffuse);  // where paths of one hit are many or few, the branch is foreseen
    uint32_t row = 0;
    int left = num_hits;
    do {
      for (int step = 0; step < 4; ++step) {
        const auto present = static_cast<uint32_t>((step - left) >> 31);  // all bits, or none past the end
        const uint32_t symbol = symbols_[(hits[step].mesh_id + 1) & present];
        row = table_[row + symbol + (static_cast<uint32_t>(diffuse >> step) & present & 1u)];
      }
      hits += 4;
      left -= 4;
      diffuse >>= 4;
    } while (left > 0);
    return table_[row + accept_column_] != 0;
  }

 private:
  bool takes_something_without(uint32_t mesh_class) const;
  void find_needed_bits();

  std::vector<uint32_t> symbols_;  // [1 + M] the symbol that changes nothing, then twice the class of each mesh
  // [num_states, num_symbols + 2]: where the row of the next state starts, by symbol (the one that changes nothing is
  // the last); then 1 if the state takes the path, else 0. State 0 is the start.
  std::vector<uint32_t> table_;
  std::vector<uint64_t> needed_bits_;
  uint32_t accept_column_ = 0;
  int num_states_ = 0, num_classes_ = 0;
};

// [P] bits of the meshes that each path has hits on, bit k of meshes k, k + 64, ... Costs about as much as a `narrow`.
std::vector<uint64_t> mesh_bits(const Paths& paths, Job* job = nullptr);

// [P] 1 where the automaton takes the path, else 0. Runs on all threads; raises Cancelled when the job is.
std::vector<uint8_t> matches(const Automaton& automaton, const Paths& paths, Job* job = nullptr);
// The same among the paths that are 1 in `candidates` [P]: clears those that the automaton does not take. With their mesh_bits, only
// the hits of paths that touch what they must are read.
void narrow(const Automaton& automaton, const Paths& paths, std::vector<uint8_t>& candidates, Job* job = nullptr,
            const std::vector<uint64_t>& bits = {});

}  // namespace echopath
