#pragma once
// Puts the record of a trace together from blocks of rays, while other blocks are yet to be shot.
#include <memory>
#include <vector>

#include "echopath/record/blocks/path_block.h"

namespace echopath {

class RecordWriter {
 public:
  // `paths` gets hits and path arrays; it must have none yet and must outlive the writer.
  explicit RecordWriter(Paths& paths) : paths_(paths), hits_(std::make_shared<std::vector<Hit>>()) {}
  // Returns the memory in bytes that the record of `num_blocks` blocks like these takes.
  static double num_bytes(const std::vector<PathBlock>& like, int64_t num_blocks);
  // Makes room for `num_blocks` blocks like these, so that arrays need not move as they grow. More blocks still find room.
  void expect(const std::vector<PathBlock>& like, int64_t num_blocks);
  // Appends the blocks behind those before, in this order, whatever the number of threads. Raises Cancelled when the job is
  // cancelled.
  void append(const std::vector<const PathBlock*>& blocks, Job* job = nullptr);
  // Gives the record its hits. Nothing may be appended after that.
  void finish();

 private:
  void make_room(const std::vector<const PathBlock*>& blocks, size_t num_paths, size_t num_hits);

  Paths& paths_;
  std::shared_ptr<std::vector<Hit>> hits_;
};

}  // namespace echopath
