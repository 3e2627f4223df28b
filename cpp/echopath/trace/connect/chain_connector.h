#pragma once
// Joins the last hit of a chain of diffuse hits to the antennas, in both orders of the chain (diffuse_chain.h).
#include "echopath/trace/connect/diffuse_chain.h"
#include "echopath/trace/connect/path_writer.h"

namespace echopath {

template <class Weight>
class DiffuseChainConnector {
 public:
  DiffuseChainConnector(const RayContext& context, const AntennaLegs& legs)
      : context_(context), legs_(legs), orders_(context), writer_(context), weight_(context) {}
  // Adds the paths over the chain and each leg behind its last hit. The receive legs must have been found.
  void connect(Connection& at) const;

 private:
  const RayContext& context_;
  const AntennaLegs& legs_;
  DiffuseChainOrders orders_;
  PathWriter<Weight> writer_;
  Weight weight_;
};

extern template class DiffuseChainConnector<ScalarWeight>;
extern template class DiffuseChainConnector<JonesWeight>;

}  // namespace echopath
