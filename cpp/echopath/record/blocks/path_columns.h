#pragma once
// Holds the paths of one block, column by column as in the record (Paths); adding one checks the room of all columns at
// once.
#include <complex>
#include <cstdint>
#include <vector>

namespace echopath {

struct PathRow {
  int64_t offset;  // of its first hit among those of the block
  uint64_t diffuse;
  std::complex<float> weight;
  uint32_t flags;
  uint16_t stratum;
  uint8_t num_bounces, batch;
};

class PathColumns {
 public:
  size_t size() const { return size_; }
  void clear() { size_ = 0; }
  void add(const PathRow& row) {
    if (size_ == offset.size()) grow();
    offset[size_] = row.offset;
    diffuse[size_] = row.diffuse;
    weight[size_] = row.weight;
    flags[size_] = row.flags;
    num_bounces[size_] = row.num_bounces;
    stratum[size_] = row.stratum;
    batch[size_] = row.batch;
    ++size_;
  }

  // Each column has room for at least `size` paths.
  std::vector<int64_t> offset;
  std::vector<uint64_t> diffuse;
  std::vector<std::complex<float>> weight;
  std::vector<uint32_t> flags;
  std::vector<uint16_t> stratum;
  std::vector<uint8_t> num_bounces, batch;

 private:
  void grow();

  size_t size_ = 0;
};

}  // namespace echopath
