#pragma once
// Defines the weight of a path: the policies of all parts that make paths.
//
// Each policy tells how a wave changes along a ray, and what a path keeps of it. ScalarWeight follows one polarisation,
// whose coefficients are all in the weight. JonesWeight follows field vectors, whose coefficients are all in a matrix beside
// the weight.
#include "echopath/em/polarization/hit_modes.h"
#include "echopath/trace/connect/connection.h"

namespace echopath {

class ScalarEchoes;  // packet_echoes.h
class JonesEchoes;

class ScalarWeight {
 public:
  using Echoes = ScalarEchoes;  // of the first hits of a packet
  explicit ScalarWeight(const RayContext& context) : polarization_(context.settings.polarization) {}
  // Returns the part of a coefficient that the weight holds.
  static double held(double coefficient) { return coefficient; }
  static std::complex<double> held(std::complex<double> coefficient) { return coefficient; }
  // Returns the part that the weight holds of the coefficient with which a hit scatters a wave that comes from where
  // `direction` points.
  double held_toward(const SurfaceHit& surface, const Vec3& direction) const {
    return diffuse_coefficient(response_toward(surface, polarization_, direction));
  }
  // These do nothing, because a scalar weight is the coefficient of the ray alone.
  void launch(Ray&) const {}
  void reflect(Ray&, const SurfaceHit&) const {}
  void begin_chain(Ray&) const {}
  void scatter(Ray&, const SurfaceHit&, const Vec3&) const {}
  // These do nothing, because a path has no matrix.
  void find_receive_axes(Connection&) const {}
  void set_coherent_matrix(Connection&, const Leg&) const {}
  void set_diffuse_matrix(Connection&, const Leg&) const {}
  void set_reversed_matrix(Connection&, const Leg&) const {}
  void exchange_antennas(Connection&, const Leg&) const {}
  void add_pair_matrices(Connection&) const {}

 private:
  Vec3 polarization_;
};

// Coherent paths hold the true reflections and the vector form of physical optics. Diffuse paths hold the true reflections
// of their mirrors and specular bounces, and at each diffuse hit the split of power between both polarisations
// (em/polarization/jones.h, scattered_field). In a chain of diffuse hits these matrices are multiplied: the mean power is
// that of every split in turn, and the phases between two polarisations are one random draw.
class JonesWeight {
 public:
  using Echoes = JonesEchoes;
  explicit JonesWeight(const RayContext& context) : context_(context) {}
  static double held(double) { return 1.0; }
  static std::complex<double> held(std::complex<double>) { return 1.0; }
  double held_toward(const SurfaceHit&, const Vec3&) const { return 1.0; }
  // Gives a ray the fields of both launches.
  void launch(Ray& ray) const { ray.fields = launched_fields(ray.direction); }
  // These change the fields of a ray and of its chain; they must be called before its direction changes.
  void reflect(Ray& ray, const SurfaceHit& surface) const;
  void begin_chain(Ray& ray) const;
  void scatter(Ray& ray, const SurfaceHit& surface, const Vec3& out) const;
  // Finds what the receiver sees over each receive leg; it must be called before the matrices are set.
  void find_receive_axes(Connection& at) const;
  // These set the matrix of the last path: over a receive leg or, reversed, over a transmit leg.
  void set_coherent_matrix(Connection& at, const Leg& leg) const;
  void set_diffuse_matrix(Connection& at, const Leg& leg) const;
  void set_reversed_matrix(Connection& at, const Leg& leg) const;
  // Carries the axes of the matrix of the last path, which was set over a receive leg, to the directions in which the
  // reversal leaves the receiver for the first hit and arrives at the transmitter.
  void exchange_antennas(Connection& at, const Leg& leg) const;
  // Adds the matrices of all pairs of legs; the ray's own way to the hit is the last of those in (jones_pairs.cpp).
  void add_pair_matrices(Connection& at) const;

 private:
  FieldPair fields_over(const Leg& leg, FieldPair fields) const;
  FieldPair incident_over(const Leg& leg) const;
  FieldPair axes_over(const Leg& leg) const;
  void find_modes_in(Connection& at) const;
  void find_axes_out(Connection& at) const;

  const RayContext& context_;
};

// Replay multiplies the matrix of a coherent path by cos_i. A conductor's TM part goes with the cosine of radiation instead,
// so the quotient is bounded where cos_i is small beside that.
ECHOPATH_INLINE double polarized_scale(double cos_incidence, double cos_radiation) {
  constexpr double kPolarizedGrazing = 0.05;
  return 1.0 / ScalarMath::larger(cos_incidence, kPolarizedGrazing * cos_radiation);
}

}  // namespace echopath
