#pragma once
// Paths of one block, column by column as the record has them (Paths), with one look at the room that is left for each.
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

  // At least `size` each.
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
