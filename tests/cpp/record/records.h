#pragma once
// Records of blocks that tests fill themselves.
#include "echopath/record/blocks/record_writer.h"

namespace echopath {

// `per_append`: blocks that are appended at a time, 0 for all.
inline Paths record_of(const std::vector<PathBlock>& blocks, size_t per_append = 0) {
  Paths paths;
  RecordWriter record(paths);
  std::vector<const PathBlock*> next;
  for (const PathBlock& block : blocks) {
    next.push_back(&block);
    if (next.size() == per_append) {
      record.append(next);
      next.clear();
    }
  }
  record.append(next);
  record.finish();
  return paths;
}

}  // namespace echopath
