#include "echopath/bench/read_hits.h"

namespace echopath {

uint64_t read_hits(const Paths& paths) {
  uint64_t sum = 0;
  for (size_t path = 0; path < paths.offsets.size(); ++path) {
    const Hit* hits = paths.hits->data() + paths.offsets[path];
    for (int k = 0; k < paths.num_bounces[path]; ++k) sum += hits[k].mesh_id;
    sum += paths.diffuse[path];
  }
  return sum;
}

}  // namespace echopath
