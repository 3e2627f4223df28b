#pragma once
// Says in which directions a rough surface scatters: the diffuse lobe of a material.
//
// A lobe is the power per solid angle (1/sr) over the power that is scattered, so that its integral over the half space in
// front of the surface is 1 for every angle of incidence. Lambert: cos(out)/pi. Directive, with the exponent a and the angle
// psi_r from the direction of mirroring: ((1 + cos psi_r)/2)^a/F(a). With a share B of backscatter of exponent b about the
// direction back to where the wave comes from, at the angle psi_i:
//   [(1 - B) ((1 + cos psi_r)/2)^a + B ((1 + cos psi_i)/2)^b] / [(1 - B) F(a) + B F(b)],
// where F is the integral of its own term over the half space, in closed form for whole exponents. The normalisation goes by
// the angle of incidence, so that these lobes are not reciprocal: exchanging both ends changes a lobe by the ratio of
// F cos(out). Lambert's is.
// Source: Degli-Esposti, Fuschini, Vitucci, Falciasecca 2007, equations 6 to 13; B is 1 - Lambda there.
#include <array>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/em/material.h"

namespace echopath {

// Describes where a wave meets a surface and where it goes on.
struct ScatterGeometry {
  Vec3 in, normal, out;  // unit: direction of travel, on either side of the surface, direction of travel behind it
};

class DiffuseLobe {
 public:
  explicit DiffuseLobe(const Material& material);
  bool is_lambert() const { return exponent_ == 0; }
  // Returns the lobe in 1/sr; 0 behind the surface.
  double operator()(const ScatterGeometry& at) const;
  // Returns the lobe over that of Lambert.
  double over_lambert(const ScatterGeometry& at) const;
  // Returns a direction from two numbers in [0, 1), drawn with `density` (1/sr) in front of the surface. Where a term of the
  // lobe reaches behind the surface, its directions there are folded back.
  Vec3 sample(const Vec3& in, const Vec3& normal, const std::array<double, 2>& random) const;
  double density(const ScatterGeometry& at) const;
  double density_over_lambert(const ScatterGeometry& at) const;

 private:
  // Holds the exponent of one term of a lobe, and its integral F over the half space, which is
  // even + cos(in) * sum over w of odd[w] sin(in)^(2 w).
  struct Term {
    int exponent = 0;
    double even = 0.0;
    std::vector<double> odd;

    explicit Term(int exponent);
    double integral(double cos_in) const;
  };

  int exponent_;
  double backscatter_share_;
  Term forward_, back_;
};

}  // namespace echopath
