#include "cpp/support/path_by_path.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/record/near_antenna.h"
#include "echopath/replay/factors/launch_cell.h"
#include "echopath/replay/posed/touched_meshes.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath::testing {
// A straight line over the mirrors [first, last) of a path, unfolded.
struct Line {
  double length;            // m
  Vec3 departure, arrival;  // unit directions of travel at both ends
};

namespace {

constexpr double kFourPi = 4.0 * kPi, kLambert = 1.0 / kPi;

Vec3 image(const Vec3& point, const PosedHit& mirror) {
  return point - 2.0 * mirror.normal.dot(point - mirror.point) * mirror.normal;
}

Vec3 reflected(const Vec3& direction, const PosedHit& mirror) {
  return direction - 2.0 * mirror.normal.dot(direction) * mirror.normal;
}

Line line_over(const PosedHit* hits, const Vec3& from, int first, int last, const Vec3& to) {
  Vec3 seen = from;
  for (int k = first; k < last; ++k) seen = image(seen, hits[k]);
  const Vec3 line = to - seen;
  const Vec3 arrival = line.normalized();
  Vec3 departure = arrival;
  for (int k = last; k-- > first;) departure = reflected(departure, hits[k]);
  return {line.norm(), departure, arrival};
}

// The horizontal and vertical components of a polarisation, scaled to length 1; zero along the direction. The axes are those
// of the direction at the trace, after the least rotation to this direction.
Eigen::Vector2d transverse_components(const Vec3& polarization, const Vec3& direction, const Vec3& at_trace) {
  const TransverseBasis across = transverse_basis(at_trace);
  const auto turn = Eigen::Quaterniond::FromTwoVectors(at_trace, direction);
  const Eigen::Vector2d found(polarization.dot(turn * across.horizontal), polarization.dot(turn * across.vertical));
  return found.norm() > 1e-9 ? Eigen::Vector2d(found.normalized()) : Eigen::Vector2d::Zero();
}

struct Directions {
  Vec3 departure, arrival;  // of travel at both ends, unit
};
// The directions at the trace, between the mean antennas; `hits` stand as they did then.
Directions directions_at_trace(const LocalPath& path, const PosedHit* hits, const Vec3& receiver) {
  const Vec3 ends[] = {Vec3::Zero(), receiver};
  const Vec3 &start = ends[path.is_reversed], &end = ends[!path.is_reversed];
  const bool has_points = path.last_material >= 0;
  const int first = has_points ? path.first_material : path.count, last = has_points ? path.last_material + 1 : 0;
  const Vec3 first_point = has_points ? hits[first].point : end, last_point = has_points ? hits[last - 1].point : start;
  return {line_over(hits, start, 0, first, first_point).departure,
          line_over(hits, last_point, last, path.count, end).arrival};
}

std::complex<double> polarized(const JonesMatrix& j, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return to[0] * (from[0] * std::complex<double>(j[0]) + from[1] * std::complex<double>(j[1])) +
         to[1] * (from[0] * std::complex<double>(j[2]) + from[1] * std::complex<double>(j[3]));
}

double largest_factor(const JonesMatrix& matrix) {
  double sum = 0.0;
  for (const std::complex<float> entry : matrix) sum += std::norm(std::complex<double>(entry));
  return std::sqrt(sum);
}

}  // namespace

// The launch cell on the triangle of the last material point.
struct PathByPath::Cell {
  LaunchCell cell;
  double density = 0.0;  // rays per sr
};

PathByPath::PathByPath(const Paths& paths, const Radar& radar, double time, SpecularPoints specular)
    : paths_(paths), preparer_(paths, touched_meshes(paths)), radio_(radio_constants(paths, radar)), specular_(specular),
      scene_(*paths.scene, radar, preparer_.meshes(), paths.frame.transmitter, time) {}

// The tube of the ray, on the plane of the surface at the time of the trace.
PathByPath::Cell PathByPath::cell_of(const LocalPath& path, size_t index) const {
  Cell out;
  const size_t stratum = paths_.stratum[index];
  if (path.diffuse != 0 || stratum >= paths_.frame.strata.size()) return out;
  out.density = paths_.frame.lattice_density(stratum);
  if (!paths_.curved_cell.empty() && paths_.curved_cell[index] != std::array<float, 7>{}) {
    out.cell = recorded_cell(paths_.curved_cell[index]);
  } else if (paths_.frame.footprint != Footprint::kNone) {
    std::vector<PosedHit> hits(static_cast<size_t>(path.count));
    for (int k = 0; k < path.count; ++k)
      pose_hit(path.hits[k], preparer_.at_trace(), k == path.last_material, hits[static_cast<size_t>(k)]);
    Line line =
        line_over(hits.data(), Vec3::Zero(), 0, path.first_material, hits[static_cast<size_t>(path.first_material)].point);
    double length = line.length;
    for (int before = path.first_material, k = before + 1; k <= path.last_material; ++k) {
      if (path.is_image(k)) continue;
      line =
          line_over(hits.data(), hits[static_cast<size_t>(before)].point, before + 1, k, hits[static_cast<size_t>(k)].point);
      length += line.length;
      before = k;
    }
    const PosedHit& hit = hits[static_cast<size_t>(path.last_material)];
    const double cos_in = hit.normal.dot(line.arrival), side = length / std::sqrt(out.density);
    Vec3 along = line.arrival - cos_in * hit.normal;
    along = along.norm() > 1e-9 ? along.normalized() : hit.normal.unitOrthogonal();
    const Vec3 tangents[] = {along * (side / std::max(std::abs(cos_in), 1e-3)), hit.normal.cross(along) * side};
    for (size_t a = 0; a < 2; ++a) out.cell.tangent[a] = edge_coordinates(hit.edge_u, hit.edge_v, hit.normal, tangents[a]);
    out.cell.is_known = out.cell.tangent[0].allFinite() && out.cell.tangent[1].allFinite();
  }
  out.cell.facet_area = preparer_.facet_area(path.hits[path.last_material].mesh_id);
  return out;
}

// A path between two antennas at one time.
class PathByPath::Walk {
 public:
  Walk(const LocalPath& path, const PosedHit* hits, const PosedAntenna& start, const PosedAntenna& end,
       const RadioConstants& radio)
      : path_(path), hits_(hits), radio_(radio) {
    for (int k = 0; k < path.count; ++k) {
      if (!path.is_image(k)) points_.push_back(k);
    }
    Vec3 from = start.position;
    int before = -1;
    for (const int k : points_) {
      lines_.push_back(line_over(hits, from, before + 1, k, hits[k].point));
      from = hits[k].point;
      before = k;
    }
    lines_.push_back(line_over(hits, from, before + 1, path.count, end.position));
    for (const Line& line : lines_) length_ += line.length;
    departure_ = lines_.front().departure;
    arrival_ = lines_.back().arrival;
    first_gain_ = start.toward(departure_);
    last_gain_ = end.toward(-arrival_);
  }

  double length() const { return length_; }
  const Vec3& departure() const { return departure_; }
  const Vec3& arrival() const { return arrival_; }
  std::complex<double> phasor() const { return std::polar(1.0, first_gain_.phase + last_gain_.phase); }

  // Without weight, phase of the antennas and polarisation.
  std::complex<double> factor(const Cell& cell) const {
    const double gains = radio_.transmit_power * first_gain_.power * last_gain_.power;
    if (points_.empty()) return radio_.wavelength * std::sqrt(gains) / (kFourPi * length_);
    if (lines_.front().length < kNearAntenna || lines_.back().length < kNearAntenna) return 0.0;
    if (path_.diffuse == 0) return std::sqrt(gains) / kFourPi * optics(cell);
    return std::sqrt(gains * diffuse_power()) * radio_.wavelength / kFourPi;
  }

 private:
  // prod [cos_in/r^2] [f cos_out] over the diffuse hits and the legs before and behind.
  double diffuse_power() const {
    double power = 1.0, since = lines_.front().length;
    for (size_t i = 0; i < points_.size(); ++i) {
      const PosedHit& hit = hits_[points_[i]];
      if (path_.is_diffuse(points_[i])) {
        const double cos_in = -hit.normal.dot(lines_[i].arrival), cos_out = hit.normal.dot(lines_[i + 1].departure);
        if (!(cos_in * cos_out > 0)) return 0.0;
        power *= std::abs(cos_in) / (since * since) * kLambert * std::abs(cos_out) * hit.area_ratio;
        since = 0.0;
      }
      since += lines_[i + 1].length;
    }
    return power / (since * since);
  }

  // cos_i F dS/(sqrt(D) r) at the last material point.
  std::complex<double> optics(const Cell& of) const {
    const PosedHit& hit = hits_[points_.back()];
    const Line &in = lines_[lines_.size() - 2], &out = lines_.back();
    const double cos_in = -hit.normal.dot(in.arrival), cos_out = hit.normal.dot(out.departure);
    if (!(cos_in * cos_out > 0)) return 0.0;
    const double length_in = length_ - out.length;
    const CellTangents tangents = cell_tangents(of.cell, hit);
    double tube = length_in;
    if (of.cell.is_curved) tube = root_area(tangents, hit, of.density) * std::sqrt(std::abs(cos_in));
    CellWaves<double> waves{
        std::abs(cos_in), std::abs(cos_out), cos_in > 0 ? 1.0 : -1.0, 1.0 / length_in, 1.0 / out.length, {}, {}};
    for (size_t a = 0; a < 2; ++a) {
      waves.along_arrival[a] = tangents[a].dot(in.arrival);
      waves.along_departure[a] = tangents[a].dot(out.departure);
    }
    const ComplexOf<double> filter = cell_filter_of<ScalarMath>(cell_shape(of.cell, hit, tangents), waves, radio_.filter());
    return std::abs(cos_in) * hit.area_ratio / (tube * out.length) * std::complex<double>(filter.re, filter.im);
  }

  const LocalPath& path_;
  const PosedHit* hits_;
  const RadioConstants& radio_;
  std::vector<int> points_;  // material ones
  std::vector<Line> lines_;  // before, between and behind them
  double length_ = 0.0;
  Vec3 departure_, arrival_;  // directions of travel at the antennas
  AntennaGain first_gain_, last_gain_;
};

std::vector<PathValue> PathByPath::operator()(int64_t index) const {
  const auto p = static_cast<size_t>(index);
  const LocalPaths block = preparer_({&index, 1});
  const LocalPath& path = block.paths.front();
  std::vector<PosedHit> recorded(static_cast<size_t>(path.count));
  for (int k = 0; k < path.count; ++k)
    pose_hit(path.hits[k], scene_, k == path.last_material, recorded[static_cast<size_t>(k)]);
  std::vector<PosedHit> traced(recorded.size());
  pose_hits(path, preparer_.at_trace(), traced.data());
  const Directions at_trace = directions_at_trace(path, traced.data(), paths_.frame.receiver - paths_.frame.transmitter);
  // Echoes between upright antennas are those of the vertical components, whatever the directions.
  const auto is_vertical = [](const PosedAntenna& antenna) { return antenna.polarization == Vec3::UnitZ(); };
  const bool is_upright =
      std::ranges::all_of(scene_.transmitters, is_vertical) && std::ranges::all_of(scene_.receivers, is_vertical);
  const Cell cell = path.last_material < 0 ? Cell{} : cell_of(path, p);
  std::vector<PathValue> values;
  for (const PosedAntenna& transmitter : scene_.transmitters) {
    for (const PosedAntenna& receiver : scene_.receivers) {
      const PosedAntenna& start = path.is_reversed ? receiver : transmitter;
      const PosedAntenna& end = path.is_reversed ? transmitter : receiver;
      std::vector<PosedHit> hits = recorded;
      SpecularSlide slide;
      if (specular_ == SpecularPoints::kFermat && path.last_material >= 0)
        step_to_fermat(path, start.position, slide, hits.data());
      const Walk walk(path, hits.data(), start, end, radio_);
      const std::complex<double> bare = std::complex<double>(paths_.weight[p]) * walk.phasor() * walk.factor(cell);
      PathValue value{walk.length(), bare, std::abs(bare)};
      if (!paths_.jones.empty()) {
        const JonesMatrix& matrix = paths_.jones[p];
        const Directions own{walk.departure(), walk.arrival()};
        const Directions& of_axes = is_upright && path.last_material >= 0 ? own : at_trace;
        value.amplitude *= polarized(matrix, transverse_components(start.polarization, own.departure, of_axes.departure),
                                     transverse_components(end.polarization, own.arrival, of_axes.arrival));
        value.largest *= largest_factor(matrix);
      }
      values.push_back(value);
    }
  }
  return values;
}

}  // namespace echopath::testing
