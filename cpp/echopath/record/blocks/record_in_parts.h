#pragma once
// Puts the record of a trace together in parts, of which each is finished before the next one begins: what is left out of
// them takes no memory.
#include <functional>
#include <optional>
#include <vector>

#include "echopath/record/blocks/record_writer.h"

namespace echopath {

class RecordInParts {
 public:
  // `empty` has the scene, the radar and the frame of the record, and outlives this. A part is complete once it has
  // `paths_per_part` or more, without which there is one; `finished` takes it and returns what of it the record has, in the
  // same order.
  RecordInParts(const Paths& empty, std::optional<int64_t> paths_per_part, std::function<Paths(Paths)> finished);
  // Makes room for `num_blocks` blocks like these in a record of one part.
  void expect(const std::vector<PathBlock>& like, int64_t num_blocks);
  // Appends the blocks behind those before, in this order, whatever the number of threads. Raises Cancelled when the job is
  // cancelled.
  void append(const std::vector<const PathBlock*>& blocks, Job* job);
  // Returns the record. Nothing may be appended after that.
  Paths take();

 private:
  void begin_part();
  Paths end_part();
  void add(const Paths& part);

  const Paths& empty_;
  std::optional<int64_t> paths_per_part_;
  std::function<Paths(Paths)> finished_;
  Paths part_, whole_;
  std::shared_ptr<std::vector<Hit>> hits_;  // of the whole; none before its first part
  std::optional<RecordWriter> writer_;      // of the part
};

}  // namespace echopath
