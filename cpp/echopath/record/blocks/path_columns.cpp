#include "echopath/record/blocks/path_columns.h"

namespace echopath {

void PathColumns::grow() {
  const size_t room = 2 * size_ + 64;
  offset.resize(room);
  diffuse.resize(room);
  weight.resize(room);
  flags.resize(room);
  num_bounces.resize(room);
  stratum.resize(room);
  batch.resize(room);
}

}  // namespace echopath
