#pragma once
// Values over the nodes of a level, side by side: what loops over nodes run along.
#include <cstddef>
#include <vector>

namespace echopath {

// [entry, row, node]
class NodeRows {
 public:
  NodeRows() = default;
  NodeRows(size_t num_entries, size_t num_rows, size_t num_nodes)
      : num_rows_(num_rows), num_nodes_(num_nodes), values_(num_entries * num_rows * num_nodes) {}

  size_t num_nodes() const { return num_nodes_; }
  double* row(size_t entry, size_t row) { return values_.data() + (entry * num_rows_ + row) * num_nodes_; }
  const double* row(size_t entry, size_t row) const { return values_.data() + (entry * num_rows_ + row) * num_nodes_; }

 private:
  size_t num_rows_ = 0, num_nodes_ = 0;
  std::vector<double> values_;
};

}  // namespace echopath
