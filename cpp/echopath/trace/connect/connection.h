#pragma once
// Describes a hit that is being connected to the receiver, with all that its paths are made of.
#include "echopath/em/polarization/hit_modes.h"
#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/connect/antenna_legs.h"

namespace echopath {

// Holds the modes that the fields of both launches excite at a diffuse hit, as far as the hit keeps them.
struct ModesIn {
  VectorOf<double> direction;
  ModeAxes axes;
  std::complex<double> te[2], tm[2];  // [launch]
};

// Holds the fields that leave a hit along which a receiver sees its two components, in parts across the way out.
struct AxesOut {
  VectorOf<double> direction;
  BasisAcross across;
  std::complex<double> horizontal[2], vertical[2];  // [component]
};

// Holds the axes along which field vectors are seen at one hit, in a polarised trace; it is kept from hit to hit for its
// memory.
struct HitFields {
  std::vector<FieldPair> axes;  // of the receive legs, as the receiver sees them
  std::vector<ModesIn> modes_in;
  std::vector<AxesOut> axes_out;
};

struct Connection {
  Ray& ray;
  const SurfaceHit& surface;
  HitLegs& legs;
  HitFields& fields;
  PathBlock& block;  // gets the paths

  // Returns the axes of one of the receive legs, in a polarised trace.
  const FieldPair& axes_of(const Leg& leg) const { return fields.axes[&leg - legs.receive.data()]; }
};

}  // namespace echopath
