#pragma once
// Defines where the coefficients of a path over an edge are kept: the policies of edges, as weight.h has those of rays.
//
// ScalarCoefficients follow the transmit polarisation, and keep all coefficients in the weight. JonesCoefficients leave them
// to replay, which has the fields of both antennas at the edge (edge_echoes.h).
#include <cmath>
#include <complex>

#include "echopath/em/polarization/jones.h"
#include "echopath/record/blocks/path_block.h"

namespace echopath {

class ScalarCoefficients {
 public:
  explicit ScalarCoefficients(const Vec3& polarization) : polarization_(polarization) {}
  // Returns the part of the coefficients of the mirrors that the weight holds.
  static std::complex<double> held(std::complex<double> of_mirrors) { return of_mirrors; }
  // Gives the last path of a block its matrix, which a scalar path does not have.
  static void add_matrix(PathBlock&) {}
  // Returns the strength of what comes along `direction`; strength_of(field) is that of a unit field across it.
  template <class StrengthOf>
  double strongest(const Vec3& direction, const StrengthOf& strength_of) const {
    return strength_of(across(direction));
  }
  // Returns how much of a field that leaves along `direction` a receiver there takes in.
  double received(const Vec3& direction, const FieldVector& field) const {
    return std::abs((across(direction).cast<std::complex<double>>().transpose() * field).value());
  }

 private:
  Vec3 across(const Vec3& direction) const {
    return (polarization_ - direction.dot(polarization_) * direction).normalized();
  }

  Vec3 polarization_;
};

class JonesCoefficients {
 public:
  explicit JonesCoefficients(const Vec3&) {}
  static std::complex<double> held(std::complex<double>) { return 1.0; }
  static void add_matrix(PathBlock& block) { block.set_jones({1.0f, 0.0f, 0.0f, 1.0f}); }
  // Returns the strength of both polarisations together.
  template <class StrengthOf>
  double strongest(const Vec3& direction, const StrengthOf& strength_of) const {
    const Vec3 first = direction.unitOrthogonal();
    return std::hypot(strength_of(first), strength_of(direction.cross(first)));
  }
  // Returns what a receiver of the field's own polarisation takes in.
  double received(const Vec3&, const FieldVector& field) const { return field.norm(); }
};

}  // namespace echopath
