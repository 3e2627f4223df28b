#include "echopath/validity/frame/path_sample.h"

#include <algorithm>

#include "echopath/validity/validity.h"

namespace echopath {
namespace {

// The kinds of paths are told apart by the object of the last hit, by coherence and by the number of bounces.
class PathKinds {
 public:
  explicit PathKinds(const Paths& paths) : paths_(paths), count_(paths.scene->nodes().size() * kKinds) {
    for (int64_t path = 0; path < paths.num_paths(); ++path) ++count_[of(path)];
  }
  size_t of(int64_t path) const {
    const int bounces = paths_.num_bounces[path];
    const Hit& last = paths_.hits_of(path)[std::max(0, bounces - 1)];
    const auto object = static_cast<size_t>(paths_.scene->meshes()[last.mesh_id].object);
    return kKinds * object + 4 * is_coherent(path) + static_cast<size_t>(std::min(bounces, 4) - 1);
  }
  bool is_coherent(int64_t path) const { return paths_.diffuse[path] == 0; }
  const std::vector<int64_t>& count() const { return count_; }

 private:
  static constexpr size_t kKinds = 8;  // of an object

  const Paths& paths_;
  std::vector<int64_t> count_;  // paths of each kind
};

}  // namespace

PathSample sample_of(const Paths& paths, bool all) {
  const PathKinds kinds(paths);
  PathSample sample;
  std::vector<int64_t> seen(kinds.count().size());
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    const size_t kind = kinds.of(path);
    const int64_t count = kinds.count()[kind];
    const int64_t step = all || kinds.is_coherent(path) ? 1 : (count + kPathsChecked - 1) / kPathsChecked;
    if (seen[kind]++ % step != 0) continue;
    sample.paths.push_back(path);
    // Each path stands for `step` paths, but the last one of a kind may stand for fewer.
    sample.weights.push_back(static_cast<float>(std::min(step, count - seen[kind] + 1)));
  }
  return sample;
}

}  // namespace echopath
