// Path expressions over hits: hits per second on one thread, beside a bare loop that reads the same memory.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <string>

#include "cpp/label/hand_made_paths.h"
#include "echopath/base/parallel.h"
#include "echopath/label/automaton.h"
#include "echopath/label/expression.h"

namespace {

using namespace echopath;

constexpr size_t kNumPaths = 500'000;
constexpr int kRepetitions = 15;
constexpr const char* kExpressions[] = {"T .* R", "T .* 'street/wall*' .* R", "T 'pedestrian' R",
                                        "T (S+ | D['street' '*left'] .{1,3})+ R"};

// Mesh IDs added up: what any pass over the hits must at least read.
uint64_t read_all(const Paths& paths) {
  uint64_t sum = 0;
  for (size_t path = 0; path < paths.offsets.size(); ++path) {
    const Hit* hits = paths.hits->data() + paths.offsets[path];
    for (int k = 0; k < paths.num_bounces[path]; ++k) sum += hits[k].mesh_id;
    sum += paths.diffuse[path];
  }
  return sum;
}

template <class Work>
double best_seconds(Work work) {
  double best = 1e300;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return best;
}

}  // namespace

int main() {
  set_num_threads(1);
  for (const uint32_t max_hits : {1u, 2u, 4u, 16u}) {
    const Paths paths = testing::make_paths(testing::random_paths(kNumPaths, 1, max_hits, 1));
    const auto num_hits = static_cast<double>(paths.num_hits());
    volatile uint64_t kept = 0;
    const double bare = best_seconds([&] { kept = kept + read_all(paths); });
    std::printf("1 to %2u hits a path: bare loop %6.0f M hits/s\n", max_hits, num_hits / bare * 1e-6);
    for (const char* text : kExpressions) {
      const Automaton automaton(parse_path_expression(text), paths.scene->mesh_names());
      const double seconds = best_seconds([&] { kept = kept + matches(automaton, paths).back(); });
      std::printf("  %-40s %4d states %6.0f M hits/s, %.2f times the bare loop\n", text, automaton.num_states(),
                  num_hits / seconds * 1e-6, seconds / bare);
    }
  }
}
