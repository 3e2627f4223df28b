#pragma once
// A hit that is being connected to the receiver, with all that its paths are made of.
#include "echopath/em/hit_modes.h"
#include "echopath/trace/connect/antenna_legs.h"
#include "echopath/trace/record/path_block.h"

namespace echopath {

// The modes of launches that arrive at a diffuse hit, as far as it keeps them.
struct ModesIn {
  VectorOf<double> direction;
  ModeAxes axes;
  std::complex<double> te[2], tm[2];  // [launch]
};

// Along which of the fields that leave a hit a receiver sees its two components, in parts across the way out.
struct AxesOut {
  VectorOf<double> direction;
  BasisAcross across;
  std::complex<double> horizontal[2], vertical[2];  // [component]
};

// What field vectors are seen along at one hit, where polarised; kept from one to the next for its memory.
struct HitFields {
  std::vector<FieldPair> axes;  // of the receive legs, as the receiver sees them
  std::vector<ModesIn> modes_in;
  std::vector<AxesOut> axes_out;
};

struct Connection {
  const Ray& ray;
  const SurfaceHit& surface;
  HitLegs& legs;
  HitFields& fields;
  PathBlock& block;  // gets the paths

  // Of one of the receive legs, where polarised.
  const FieldPair& axes_of(const Leg& leg) const {
    return fields.axes[static_cast<size_t>(&leg - legs.receive.data())];
  }
};

}  // namespace echopath
