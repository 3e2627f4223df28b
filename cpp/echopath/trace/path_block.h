#pragma once
// What one chunk of rays records; chunks are joined in their order.
#include <vector>

#include "echopath/trace/paths.h"

namespace echopath {

class PathBlock {
 public:
  std::vector<Hit> hits;
  std::vector<int64_t> offsets;  // relative to this block
  std::vector<uint8_t> num_bounces;
  std::vector<uint64_t> diffuse;
  std::vector<std::complex<float>> weight;
  std::vector<uint8_t> stratum, batch;
  std::vector<uint32_t> flags;
  uint8_t current_batch = kNoBatch;  // of the paths added from now on
  std::vector<std::array<float, 7>> curved_cell;  // of the paths so far that end behind a curved bounce, and zeros before them
  std::vector<JonesMatrix> jones;  // likewise
  TraceStatistics statistics;

  // A path with hits of its own.
  void add(const Hit* first, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);
  // A path over hits [skipped, skipped + count) of the current ray, which all such paths share.
  void add_prefix(int skipped, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);
  // A path over `first` [count], given in the order in which it was traced, that runs the other way (kReversedPath).
  void add_reversal(const Hit* first, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);
  // Give the last path added its matrix (Paths::jones) and a launch cell of its own (Paths::curved_cell).
  void set_jones(const JonesMatrix& matrix);
  void set_curved_cell(const std::array<float, 7>& cell);
  // Stores the hits of the current ray as far as its paths use them.
  void end_ray(const Hit* ray_hits);
  // Gives back what its vectors hold in reserve: for all blocks together that would be as much as the record.
  void shrink_to_fit();

 private:
  void add_record(int64_t offset, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum);

  std::vector<size_t> pending_;  // paths of the current ray whose offset is still relative to the ray
  int used_depth_ = 0;
};

// Joins blocks in order into `paths` (hits and path arrays only), freeing each block. Raises Cancelled when the job is.
void join_blocks(std::vector<PathBlock>& blocks, Paths& paths, Job* job = nullptr);

}  // namespace echopath
