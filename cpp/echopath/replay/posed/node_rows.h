#pragma once
// Holds values at the nodes of a time grid side by side, so that loops can run along the nodes.
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace echopath {

// The values are [entry, row, stride]: a row has one value for each node, and behind them values that fill its last vector
// and are not used.
class NodeRows {
 public:
  static constexpr size_t kVector = 8;  // nodes, whatever the instruction set
  static size_t stride_of(size_t num_nodes) { return num_nodes == 1 ? 1 : (num_nodes + kVector - 1) / kVector * kVector; }

  // Keeps the memory that it has where this suffices; the values are not set.
  void resize(size_t num_entries, size_t num_rows, size_t num_nodes) {
    num_rows_ = num_rows;
    num_nodes_ = num_nodes;
    stride_ = stride_of(num_nodes);
    reserve(num_entries * num_rows * stride_);
  }

  size_t num_bytes() const { return capacity_ * sizeof(double); }  // of its memory
  size_t num_nodes() const { return num_nodes_; }
  size_t stride() const { return stride_; }
  double* row(size_t entry, size_t row) { return values_.get() + (entry * num_rows_ + row) * stride_; }
  const double* row(size_t entry, size_t row) const { return values_.get() + (entry * num_rows_ + row) * stride_; }
  // Fills the last vector of a row with the value of its last node.
  void pad(size_t entry, size_t row) {
    double* values = this->row(entry, row);
    for (size_t node = num_nodes_; node < stride_; ++node) values[node] = values[num_nodes_ - 1];
  }

 private:
  struct Free {
    void operator()(double* values) const { std::free(values); }
  };
  void reserve(size_t count) {
    constexpr size_t kAlignment = kVector * sizeof(double);
    if (count <= capacity_) return;
    capacity_ = (count + count / 4 + kVector - 1) / kVector * kVector;
    values_.reset();
    values_.reset(static_cast<double*>(std::aligned_alloc(kAlignment, capacity_ * sizeof(double))));
    if (!values_) throw std::bad_alloc();
  }

  size_t num_rows_ = 0, num_nodes_ = 0, stride_ = 0, capacity_ = 0;
  std::unique_ptr<double[], Free> values_;
};

}  // namespace echopath
