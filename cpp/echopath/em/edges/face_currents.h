#pragma once
// Integrates the fringe currents that a wave makes on one face of a wedge (edge_diffraction.h). Internal to the module.
#include "echopath/base/geometry.h"

namespace echopath {

// Describes a face that ends at an edge by two unit vectors across the edge.
struct WedgeFace {
  Vec3 inward;  // in the face, away from the edge
  Vec3 normal;  // of its outside
};

// Holds what the wave determines of the currents, so that each direction in which they radiate costs little.
class FaceCurrents {
 public:
  // The wave travels along the unit vector `in`; `angle` (rad) is that of its source from the face, and `n` is the exterior
  // angle over pi. The integrals of a current's two components along the strip are those of the exact solution less `lit`
  // times those of the incident field: 2 for physical optics on a lit face.
  FaceCurrents(const WedgeFace& face, double n, double angle, double lit, const Vec3& in);
  // Returns the part of fringe_matrix that the face makes toward the unit vector `out`, with its part along `out`.
  Mat3 toward(const Vec3& out) const;

 private:
  struct SineCosine {
    explicit SineCosine(double angle);
    double of_twice() const { return 2.0 * sine * cosine; }  // its sine

    double sine, cosine;
  };
  // Holds an angle by functions of its half and of the n-th part of that.
  struct Halves {
    Halves(double angle, double n) : half(0.5 * angle), part(0.5 * angle / n) {}

    SineCosine half, part;
  };
  struct AtAngle;
  AtAngle at(double cosine) const;
  AtAngle beside_source(double w) const;

  Vec3 inward_, edge_, magnetic_, ahead_;
  double n_, lit_, cosine_, sine_, angle_;
  Halves source_;
};

}  // namespace echopath
