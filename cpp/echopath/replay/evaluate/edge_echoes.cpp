#include "echopath/replay/evaluate/edge_echoes.h"

#include <cmath>
#include <optional>

#include "echopath/base/constants.h"
#include "echopath/em/edges/edge_diffraction.h"
#include "echopath/em/edges/edge_shadow.h"
#include "echopath/em/edges/multiple_diffraction.h"
#include "echopath/em/polarization/mirrored_fields.h"
#include "echopath/record/posed_edge.h"
#include "echopath/replay/factors/path_weight.h"
#include "echopath/replay/kernels/path_formula.h"

namespace echopath {
namespace {

// Describes the wave that comes from an antenna to an edge.
struct WaveAtEdge {
  double length, root_gain, phase;  // m; of the antenna, rad
  Vec3 direction;                   // unit, of travel where it arrives
  FieldVector field;                // of a unit wave, where it arrives; zero in the scalar model
};

// Holds the mirrors between an antenna and an edge, in the order of travel from the antenna.
struct MirrorsToEdge {
  std::vector<PosedHit> hits;
  std::vector<const Material*> materials;
  bool is_forward;  // the antenna is at the transmitter's end of the record
  int last_leg;     // of the path

  int leg(size_t mirror) const { return is_forward ? static_cast<int>(mirror) : last_leg - static_cast<int>(mirror); }
};

// These policies tell which fields are at an edge. Scalar ones are those of the transmitter's polarisation at both ends, and
// the weight has what mirrors made of them; Jones ones are those of each antenna, as they have come over the mirrors.
struct ScalarFields {
  static constexpr bool kComeOverMirrors = false;
  static FieldVector seen(const WaveAtEdge&, const Vec3& polarization, const Vec3& direction) {
    return unit_part_across(polarization, direction).cast<std::complex<double>>();
  }
};

struct JonesFields {
  static constexpr bool kComeOverMirrors = true;
  static const FieldVector& seen(const WaveAtEdge& wave, const Vec3&, const Vec3&) { return wave.field; }
};

template <class Fields>
class EdgeEchoes {
 public:
  EdgeEchoes(const PathPreparer& preparer, const RadioConstants& radio)
      : paths_(preparer.paths()), radio_(radio), frequency_(kSpeedOfLight / radio.wavelength), hits_(64) {}

  // Sets the path that is looked at, at a node. `sheets` are those on its way that turn polarisations, or null. Without
  // `with_amplitudes` it is looked at for its lengths alone.
  void pose(const LocalPath& path, const PosedScene& scene, PathPassages* sheets, bool with_amplitudes) {
    sheets_ = sheets;
    if (sheets_) sheets_->pose(scene);
    pose_hits(path, scene, hits_.data());
    edges_.clear();
    for (int k = path.edge; k < path.edge + path.num_edges; ++k)
      edges_.push_back({posed_wedge(*path.hits[k].edge, scene, path.hits[k].mesh_id), hits_[k].point});
    const LocalHit& hit = path.hits[path.edge];
    const Vec3 corners[] = {hit.corner, hit.corner + hit.edge_u, hit.corner + hit.edge_v};
    const Vec3 side = scene.linear(hit.mesh_id) * (corners[(hit.edge->side + 1) % 3] - corners[hit.edge->side]);
    piece_ = (hit.edge->end - hit.edge->begin) / hit.num_pieces * side;
    if (path.num_edges > 1) multiple_ = MultipleDiffraction::over(edges_, radio_.wavenumber);
    else multiple_.reset();
    if (multiple_) piece_ = multiple_->last_piece(piece_);
    is_reversed_ = path.is_reversed;
    is_past_edge_ = (path.flags & kPastEdge) != 0;
    find_waves(path, scene.antennas(is_reversed_), true, in_);
    find_waves(path, scene.antennas(!is_reversed_), false, out_);
    if (with_amplitudes) find_diffraction();
  }

  double length(size_t transmitter, size_t receiver) const {
    const WaveAtEdge& in = in_[index_in(transmitter, receiver)];
    const double over_faces = multiple_ ? multiple_->length() + multiple_->detour(in.direction, in.length) : 0.0;
    return in.length + over_faces + out_[index_out(transmitter, receiver)].length;
  }

  // `polarization` is that of the transmitter.
  std::complex<double> amplitude(size_t transmitter, size_t receiver, const Vec3& polarization,
                                 std::complex<double> weight) const {
    const size_t index_in = this->index_in(transmitter, receiver), index_out = this->index_out(transmitter, receiver);
    const WaveAtEdge &in = in_[index_in], &out = out_[index_out];
    if (!reaches_antenna(in.length) || !reaches_antenna(out.length) || is_broken()) return 0.0;
    const Vec3 departure = -out.direction;
    const std::complex<double> coupled = Fields::seen(out, polarization, departure).transpose() *
                                         diffracted(Fields::seen(in, polarization, in.direction), index_in, index_out);
    const double size = edge_amplitude(radio_.coherent_scale() * in.root_gain * out.root_gain, piece_.norm(),
                                       radio_.wavenumber, in.length, out.length);
    const std::complex<double> factor =
        size * coupled * filter(in, departure, out.length) * std::polar(1.0, in.phase + out.phase);
    const ComplexOf<double> found = amplitude_of<ScalarMath>(ComplexOf<double>{weight.real(), weight.imag()},
                                                             ComplexOf<double>{factor.real(), factor.imag()});
    return {found.re, found.im};
  }

 private:
  // A reversed path begins at the receiver.
  size_t index_in(size_t transmitter, size_t receiver) const { return is_reversed_ ? receiver : transmitter; }
  size_t index_out(size_t transmitter, size_t receiver) const { return is_reversed_ ? transmitter : receiver; }

  // Returns whether the points of several edges no longer lie on flat faces that connect them.
  bool is_broken() const { return edges_.size() > 1 && !multiple_; }

  // Finds what the wave of each antenna determines by itself.
  void find_diffraction() {
    fringes_.clear();
    entered_.clear();
    left_.clear();
    for (const WaveAtEdge& in : in_) {
      if (multiple_) entered_.push_back(multiple_->enter(in.direction, in.length));
      else if (!is_past_edge_) fringes_.emplace_back(edges_.front().wedge, in.direction);
    }
    for (const WaveAtEdge& out : out_) {
      if (multiple_) left_.push_back(multiple_->leave(-out.direction, out.length));
    }
  }

  // Returns what leaves the last edge toward an antenna of the field that another one sends to the first.
  FieldVector diffracted(const FieldVector& field, size_t index_in, size_t index_out) const {
    if (multiple_) return left_[index_out] * (entered_[index_in].transpose() * field).value();
    const WaveAtEdge& in = in_[index_in];
    const Vec3 departure = -out_[index_out].direction;
    if (!is_past_edge_) return fringes_[index_in].toward(departure) * field;
    const DiffractingEdge& edge = edges_.front();
    // `mirrors_` are those at the end of the path, of which the last one is next to the edge.
    const PosedHit& next = mirrors_.hits.back();
    const double behind = next.normal.dot(next.point - edge.point) / next.normal.dot(departure);
    const double phase = radio_.wavenumber * in.length * behind / (in.length + behind);
    return diffraction_matrix(edge.wedge, in.direction, departure, std::max(phase, 0.0)) * field;
  }

  // Waves of multiple diffraction run along one ray of Keller's cone to each point of the last edge.
  std::complex<double> filter(const WaveAtEdge& in, const Vec3& departure, double distance) const {
    const Vec3 arrival = multiple_ ? multiple_->arrival() : in.direction;
    const double travelled = multiple_ ? in.length + multiple_->length() : in.length;
    const auto curvature = [&](const Vec3& direction, double radius) {
      return direction.cross(piece_).squaredNorm() / radius;
    };
    const double quadratic_phase =
        0.125 * radio_.wavenumber * (curvature(arrival, travelled) + curvature(departure, distance));
    return edge_filter(radio_.wavenumber * (arrival - departure).dot(piece_), quadratic_phase);
  }

  // Finds the waves between the edges and the antennas at the start of the path as it was traced, or at its end.
  void find_waves(const LocalPath& path, const std::vector<PosedAntenna>& antennas, bool of_start,
                  std::vector<WaveAtEdge>& waves) {
    mirrors_.hits.clear();
    mirrors_.materials.clear();
    const int count = of_start ? path.edge : path.count - path.edge - path.num_edges;
    for (int k = 0; k < count; ++k) {
      const int at = of_start ? k : path.count - 1 - k;
      mirrors_.hits.push_back(hits_[at]);
      mirrors_.materials.push_back(paths_.scene->node_of(path.hits[at].mesh_id).material.get());
    }
    mirrors_.is_forward = of_start != path.is_reversed;
    mirrors_.last_leg = path.count;
    waves.clear();
    const Vec3& point = of_start ? edges_.front().point : edges_.back().point;
    for (const PosedAntenna& antenna : antennas) waves.push_back(wave_from(antenna, point));
  }

  WaveAtEdge wave_from(const PosedAntenna& antenna, const Vec3& point) const {
    const int count = static_cast<int>(mirrors_.hits.size());
    const UnfoldedLeg leg = unfolded_leg(mirrors_.hits.data(), antenna.position, 0, count, point);
    const AntennaGain gain = antenna.toward(leg.departure);
    FieldVector field = FieldVector::Zero();
    if constexpr (Fields::kComeOverMirrors) field = over_mirrors(antenna, leg.departure);
    return {leg.length, std::sqrt(gain.power), gain.phase, leg.arrival, field};
  }

  FieldVector over_mirrors(const PosedAntenna& antenna, Vec3 direction) const {
    FieldVector field = unit_part_across(antenna.polarization, direction).cast<std::complex<double>>();
    const auto pass = [&](size_t leg) {
      if (sheets_) field = sheets_->through({mirrors_.leg(leg), antenna.position, mirrors_.is_forward}, field);
    };
    for (size_t k = 0; k < mirrors_.hits.size(); ++k) {
      pass(k);
      const SurfaceModel model(*mirrors_.materials[k], frequency_);
      carry_over_mirror({&field, 1}, direction, mirrors_.hits[k].normal, model);
    }
    pass(mirrors_.hits.size());
    return field;
  }

  const Paths& paths_;
  const RadioConstants& radio_;
  double frequency_;  // Hz
  bool is_reversed_ = false, is_past_edge_ = false;
  std::vector<PosedHit> hits_;
  MirrorsToEdge mirrors_;
  PathPassages* sheets_ = nullptr;
  std::vector<WaveAtEdge> in_, out_;
  std::vector<DiffractingEdge> edges_;           // of the path
  std::optional<MultipleDiffraction> multiple_;  // over them, where there are several
  std::vector<Fringe> fringes_;                  // of in_, at a single edge
  std::vector<FieldVector> entered_, left_;      // of in_ and out_, over several edges (MultipleDiffraction)
  Vec3 piece_;                                   // m, of the last one
};

// Holds the sheets on those edge paths whose fields are followed through them, null for the others.
class SheetsOnPaths {
 public:
  SheetsOnPaths(const RecordSheets& sheets, std::span<const int64_t> paths) : of_path_(paths.size()) {
    const Paths& record = sheets.preparer.paths();
    if (record.jones.empty() || record.passes.empty()) return;
    for (size_t i = 0; i < paths.size(); ++i) {
      if (!record.passes_of(paths[i]).empty()) of_path_[i] = &all_.emplace_back(sheets, paths[i]);
    }
  }
  PathPassages* of(size_t place) const { return of_path_[place]; }

 private:
  std::deque<PathPassages> all_;
  std::vector<PathPassages*> of_path_;
};

template <class Fields>
void evaluate(const SharedLegPlan& plan, const RecordSheets& sheets, const PosedNodes& nodes, const RadioConstants& radio,
              const ChannelSpan& channels, bool with_amplitudes) {
  std::vector<int64_t> indices;
  for (const SharedLegPlan::PlannedPath& path : plan.edge_paths) indices.push_back(path.path);
  const PathPreparer& preparer = sheets.preparer;
  const LocalPaths local = preparer(indices);
  const SheetsOnPaths on_paths(sheets, indices);
  EdgeEchoes<Fields> echoes(preparer, radio);
  for (size_t node = 0; node < nodes.size(); ++node) {
    const PosedScene& scene = nodes.at(node);
    const size_t num_receivers = scene.receivers.size();
    for (size_t i = 0; i < indices.size(); ++i) {
      const std::complex<double> weight = weight_of(preparer.paths(), static_cast<size_t>(indices[i]));
      echoes.pose(local.paths[i], scene, on_paths.of(i), with_amplitudes);
      for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
        const size_t of_all = channels.first + channel, transmitter = of_all / num_receivers,
                     receiver = of_all % num_receivers;
        const Vec3& polarization = scene.transmitters[transmitter].polarization;
        const std::complex<double> amplitude =
            with_amplitudes ? echoes.amplitude(transmitter, receiver, polarization, weight) : 0.0;
        channels.nodes[channel].set(node, plan.edge_paths[i].place, echoes.length(transmitter, receiver), amplitude);
      }
    }
  }
}

}  // namespace

void evaluate_edges(const SharedLegPlan& plan, const RecordSheets& sheets, const PosedNodes& nodes,
                    const RadioConstants& radio, const ChannelSpan& channels, bool with_amplitudes) {
  if (plan.edge_paths.empty()) return;
  const auto run = sheets.preparer.paths().jones.empty() ? evaluate<ScalarFields> : evaluate<JonesFields>;
  run(plan, sheets, nodes, radio, channels, with_amplitudes);
}

}  // namespace echopath
