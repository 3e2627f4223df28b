#include "echopath/em/surface/diffuse_lobe.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/plane.h"

namespace echopath {
namespace {

constexpr double kLeastCosine = 1e-9;  // the quotient of a lobe and Lambert's is finite beside the surface

double power_of(double base, int exponent) {
  double result = 1.0;
  for (; exponent > 0; exponent /= 2, base *= base) {
    if (exponent % 2) result *= base;
  }
  return result;
}

// Returns the lobe of one term without its integral, about the unit vector `axis`.
double term_at(const Vec3& out, const Vec3& axis, int exponent) {
  return power_of(std::max(0.0, 0.5 * (1.0 + out.dot(axis))), exponent);
}

// Returns the density of a term that is drawn over all directions and folded to the front.
double folded_density(const Vec3& out, const Vec3& normal, const Vec3& axis, int exponent) {
  const double both = term_at(out, axis, exponent) + term_at(mirrored(out, normal), axis, exponent);
  return (exponent + 1) / (4.0 * kPi) * both;
}

Vec3 drawn_about(const Vec3& axis, int exponent, const std::array<double, 2>& random) {
  const double cosine = 2.0 * std::pow(1.0 - random[0], 1.0 / (exponent + 1)) - 1.0;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), turn = kTwoPi * random[1];
  const Vec3 first = axis.unitOrthogonal(), second = axis.cross(first);
  return (cosine * axis + sine * (std::cos(turn) * first + std::sin(turn) * second)).normalized();
}

}  // namespace

// The term is the sum of C(a, j) cos(psi)^j/2^a. Over the half space, cos(psi)^j has the integral 2 pi/(j + 1) for an even
// j, and for an odd one that times cos(in) sum over w <= (j - 1)/2 of C(2 w, w) (sin(in)/2)^(2 w).
DiffuseLobe::Term::Term(int of) : exponent(of), odd(static_cast<size_t>((of + 1) / 2)) {
  double choose = power_of(0.5, of);  // C(a, j)/2^a
  for (int j = 0; j <= of; ++j) {
    const double whole = kTwoPi / (j + 1) * choose;
    if (j % 2 == 0) even += whole;
    double central = 1.0;  // C(2 w, w)/4^w
    for (int w = 0; j % 2 == 1 && w <= (j - 1) / 2; ++w) {
      odd[w] += whole * central;
      central *= (2.0 * w + 1.0) / (2.0 * w + 2.0);
    }
    choose *= static_cast<double>(of - j) / (j + 1);
  }
}

double DiffuseLobe::Term::integral(double cos_in) const {
  const double sine_squared = 1.0 - cos_in * cos_in;
  double sum = 0.0;
  for (size_t w = odd.size(); w-- > 0;) sum = sum * sine_squared + odd[w];
  return even + cos_in * sum;
}

DiffuseLobe::DiffuseLobe(const Material& material)
    : exponent_(material.lobe_exponent), backscatter_share_(material.backscatter_share), forward_(material.lobe_exponent),
      back_(material.backscatter_exponent > 0 ? material.backscatter_exponent : material.lobe_exponent) {}

double DiffuseLobe::operator()(const ScatterGeometry& at) const {
  const Vec3 normal = lit_normal(at.in, at.normal);
  const double cos_out = normal.dot(at.out), cos_in = -normal.dot(at.in);
  if (cos_out <= 0) return 0.0;
  if (is_lambert()) return cos_out / kPi;
  const double share = backscatter_share_;
  const double forward = share < 1 ? term_at(at.out, mirrored(at.in, normal), forward_.exponent) : 0.0;
  const double back = share > 0 ? term_at(at.out, -at.in, back_.exponent) : 0.0;
  const double whole = (1.0 - share) * forward_.integral(cos_in) + share * back_.integral(cos_in);
  return ((1.0 - share) * forward + share * back) / whole;
}

double DiffuseLobe::over_lambert(const ScatterGeometry& at) const {
  if (is_lambert()) return 1.0;
  return (*this)(at)*kPi / std::max(kLeastCosine, std::abs(at.normal.dot(at.out)));
}

// A term is drawn as often as its share of the power is; the first number serves for that, too.
Vec3 DiffuseLobe::sample(const Vec3& in, const Vec3& normal, const std::array<double, 2>& random) const {
  const bool is_back = random[0] < backscatter_share_;
  const double share = is_back ? backscatter_share_ : 1.0 - backscatter_share_;
  const double first = std::clamp((random[0] - (is_back ? 0.0 : backscatter_share_)) / share, 0.0, 1.0 - 1e-16);
  const Vec3 axis = is_back ? Vec3(-in) : mirrored(in, normal);
  const Vec3 drawn = drawn_about(axis, is_back ? back_.exponent : forward_.exponent, {first, random[1]});
  return drawn.dot(lit_normal(in, normal)) > 0 ? drawn : mirrored(drawn, normal);
}

double DiffuseLobe::density(const ScatterGeometry& at) const {
  const double share = backscatter_share_;
  double sum = 0.0;
  if (share < 1) sum += (1.0 - share) * folded_density(at.out, at.normal, mirrored(at.in, at.normal), forward_.exponent);
  if (share > 0) sum += share * folded_density(at.out, at.normal, -at.in, back_.exponent);
  return sum;
}

double DiffuseLobe::density_over_lambert(const ScatterGeometry& at) const {
  if (is_lambert()) return 1.0;
  return density(at) * kPi / std::max(kLeastCosine, std::abs(at.normal.dot(at.out)));
}

}  // namespace echopath
