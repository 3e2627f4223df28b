// Runs automata over the paths of a record.
#include <cstring>

#include "echopath/base/lanes/simd.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/label/expressions/automaton.h"

namespace echopath {
namespace {

constexpr int64_t kPathsMatchedTogether = 1 << 14;  // 0.2 ms of work at most
constexpr size_t kWord = sizeof(uint64_t);

ECHOPATH_INLINE void keep_touching(const uint64_t* bits, uint64_t needed, size_t count, uint8_t* candidates) {
  for (size_t i = 0; i < count; ++i) candidates[i] &= static_cast<uint8_t>((bits[i] & needed) != 0);
}

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

std::vector<uint64_t> mesh_bits(const Paths& paths, Job* job) {
  std::vector<uint64_t> bits(paths.num_paths());
  parallel_for_chunks(paths.num_paths(), kPathsMatchedTogether, [&](int64_t begin, int64_t end) {
    for (int64_t path = begin; path < end; ++path) {
      const Hit* hits = paths.hits_of(path);
      for (int k = 0; k < paths.num_bounces[path]; ++k) bits[path] |= mesh_bit(hits[k].mesh_id);
      for (const Pass& pass : paths.passes_of(path)) bits[path] |= mesh_bit(pass.hit.mesh_id);
    }
  }, job);
  return bits;
}

void narrow(const Automaton& automaton, const Paths& paths, std::vector<uint8_t>& candidates, Job* job,
            const std::vector<uint64_t>& bits) {
  const Hit* hits = paths.hits ? paths.hits->data() : nullptr;
  parallel_for_chunks(paths.num_paths(), kPathsMatchedTogether, [&](size_t begin, size_t end) {
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
  }, job);
}

}  // namespace echopath
