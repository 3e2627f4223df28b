#pragma once
// Writes the paths of a hit to its block, with all their columns.
#include "echopath/trace/connect/mirror_orders.h"
#include "echopath/trace/sbr/weight.h"

namespace echopath {

// Returns the bit of the hit where a ray is, in PathRow::diffuse.
inline uint64_t last_bit(const Ray& ray) { return uint64_t{1} << (ray.depth - 1); }

template <class Weight>
class PathWriter {
 public:
  explicit PathWriter(const RayContext& context) : context_(context), weight_(context) {}
  // Writes the path over the ray's own hits and a receive leg, and its reversal, as far as each has a share and not too many
  // hits. `diffuse` has a bit for each hit; it is 0 for coherent paths.
  void write(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight, const OrderShares& shares) const;
  // Writes the path from the transmitter over `leg` to the hit where the ray is, and back along its chain to the receiver.
  void write_reversed(Connection& at, const Leg& leg, uint64_t diffuse, std::complex<double> weight) const;

 private:
  void set_columns(Connection& at, const Leg& leg, uint64_t diffuse) const;

  const RayContext& context_;
  Weight weight_;
};

extern template class PathWriter<ScalarWeight>;
extern template class PathWriter<JonesWeight>;

}  // namespace echopath
