#include "echopath/replay/evaluate/sheet_passages.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/plane.h"
#include "echopath/trace/sheets/passes.h"

namespace echopath {
namespace {

constexpr size_t kManyPasses = 4096;  // as many as it costs to make a table
constexpr double kBeside = 0.5;       // of a triangle's edges: so far beside it a curved surface is followed

}  // namespace

// Evaluates one path at one node after the other.
class SheetPassages::OfPath {
 public:
  // Holds what sheets do on some legs.
  struct Passed {
    std::complex<double> field = 1.0;
    double delay = 0.0;  // m

    Passed operator*(const Passed& other) const { return {field * other.field, delay + other.delay}; }
  };

  OfPath(const SheetPassages& shared, int64_t path)
      : shared_(shared), paths_(shared.preparer_.paths()), passes_(paths_.passes_of(static_cast<size_t>(path))) {
    const auto p = static_cast<size_t>(path);
    count_ = paths_.num_bounces[p];
    for (int k = 0; k < count_; ++k) {
      const Hit& hit = paths_.hits_of(path)[k];
      hits_.push_back(shared.preparer_.hit(hit, normals_));
      const int edge = edge_hit(paths_.flags[p]);
      const bool is_edge = edge >= 0 && k >= edge && k < edge + num_edge_hits(paths_.flags[p]);
      const bool is_diffuse = (paths_.diffuse[p] >> k & 1) != 0;
      is_image_.push_back(!is_edge && !is_diffuse && shared.preparer_.is_image(hit.mesh_id, paths_.stratum[p]));
    }
    posed_.resize(hits_.size());
    for (const Pass& pass : passes_) sheets_.push_back(shared.preparer_.hit(pass.hit, normals_));
    posed_sheets_.resize(sheets_.size());
    for (first_material_ = 0; first_material_ < count_ && is_image_[at(first_material_)];) ++first_material_;
    for (last_material_ = count_ - 1; last_material_ >= 0 && is_image_[at(last_material_)];) --last_material_;
  }

  void pose(const PosedScene& scene) {
    scene_ = &scene;
    for (size_t k = 0; k < hits_.size(); ++k) pose_hit(hits_[k], scene, false, posed_[k]);
    for (size_t k = 0; k < sheets_.size(); ++k) pose_facet(sheets_[k], scene, posed_sheets_[k]);
    const Ends nowhere{Vec3::Zero(), Vec3::Zero()};
    start_.clear();
    end_.clear();
    if (first_material_ == count_) return;  // each pair of antennas has legs of its own
    for (const PosedAntenna& antenna : scene.transmitters) {
      start_.push_back(passed(0, first_material_, {antenna.position, Vec3::Zero()}));
    }
    inner_ = passed(first_material_ + 1, last_material_, nowhere);
    for (const PosedAntenna& antenna : scene.receivers) {
      end_.push_back(passed(last_material_ + 1, count_, {Vec3::Zero(), antenna.position}));
    }
  }

  Passed at_channel(size_t transmitter, size_t receiver) const {
    if (!start_.empty()) return start_[transmitter] * inner_ * end_[receiver];
    return passed(0, count_, {scene_->transmitters[transmitter].position, scene_->receivers[receiver].position});
  }

 private:
  struct Ends {
    Vec3 transmitter, receiver;
  };
  static size_t at(int k) { return static_cast<size_t>(k); }

  // Returns what the sheets do on the legs `first` to `last`, both included.
  Passed passed(int first, int last, const Ends& ends) const {
    Passed all;
    for (size_t begin = 0, end; begin < passes_.size(); begin = end) {
      const auto leg = static_cast<int>(passes_[begin].leg);
      for (end = begin + 1; end < passes_.size() && passes_[end].leg == passes_[begin].leg;) ++end;
      if (leg >= first && leg <= last) all = all * passed_on_leg(leg, begin, end, ends);
    }
    return all;
  }

  Passed passed_on_leg(int leg, size_t begin, size_t end, const Ends& ends) const {
    const auto [from, to] = ends_of_leg(leg, ends);
    const double length = (to - from).norm();
    const Vec3 direction = (to - from) / length;
    Passed all;
    Vec3 offset = Vec3::Zero();
    for (size_t k = begin; k < end; ++k) {
      const Vec3 normal = normal_at(k, from, direction);
      const double cosine = std::min(1.0, std::abs(direction.dot(normal)));
      const SheetPassage passage = shared_.of_mesh_[sheets_[k].mesh_id]->passage(cosine);
      const SheetFactor factor = sheet_factor(passage, te_share(shared_.polarization_, direction, normal));
      all = all * Passed{factor.field, factor.delay};
      offset += passage.offset * toward_foot(direction, normal);
    }
    const double wavenumber = kTwoPi / shared_.wavelength_;
    all.field *= std::polar(1.0, wavenumber * (all.delay - detour(offset, length, shared_.wavelength_)));
    return all;
  }

  // Returns the unit vector across the ray that leads toward the normal through its point of entry.
  static Vec3 toward_foot(const Vec3& direction, const Vec3& normal) {
    const Vec3 ahead = direction.dot(normal) > 0.0 ? normal : Vec3(-normal),
               across = ahead - ahead.dot(direction) * direction;
    const double size = across.norm();
    return size > 1e-9 ? Vec3(across / size) : Vec3(Vec3::Zero());
  }

  // Returns the normal of the sheet where a line crosses it.
  Vec3 normal_at(size_t pass, const Vec3& from, const Vec3& direction) const {
    const LocalHit& sheet = sheets_[pass];
    PosedHit posed = posed_sheets_[pass];
    if (!sheet.normals) return posed.normal;
    const Vec3 across = posed.edge_u.cross(posed.edge_v);
    const double slope = direction.dot(across);
    LocalHit there = sheet;
    if (slope != 0.0) {
      const Vec3 corner = posed.point - sheet.u * posed.edge_u - sheet.v * posed.edge_v;
      const Vec3 point = from + across.dot(corner - from) / slope * direction - corner;
      there.u = std::clamp(point.cross(posed.edge_v).dot(across) / across.squaredNorm(), -kBeside, 1.0 + kBeside);
      there.v = std::clamp(posed.edge_u.cross(point).dot(across) / across.squaredNorm(), -kBeside, 1.0 + kBeside);
    }
    pose_hit(there, *scene_, false, posed);
    return posed.normal;
  }

  // Returns the points between which a leg runs, with the points of mirrors as their images show them.
  std::pair<Vec3, Vec3> ends_of_leg(int leg, const Ends& ends) const {
    int before = leg - 1, behind = leg;
    while (before >= 0 && is_image_[at(before)]) --before;
    while (behind < count_ && is_image_[at(behind)]) ++behind;
    const Vec3 from = before < 0 ? ends.transmitter : posed_[at(before)].point;
    const Vec3 to = behind == count_ ? ends.receiver : posed_[at(behind)].point;
    // Toward each mirror from the point before, the wave travels to the image of the end over this mirror and all behind.
    Vec3 start = from;
    for (int k = before + 1; k <= behind; ++k) {
      Vec3 image = to;
      for (int mirror = behind; mirror-- > k;) image = plane_of(mirror).image(image);
      const Vec3 end = k == behind ? to : met_on_plane(start, image, plane_of(k));
      if (k == leg) return {start, end};
      start = end;
    }
    return {from, to};
  }

  Plane plane_of(int hit) const { return {posed_[at(hit)].point, posed_[at(hit)].normal}; }

  static Vec3 met_on_plane(const Vec3& from, const Vec3& to, const Plane& plane) {
    const double before = plane.height(from), behind = plane.height(to);
    return before == behind ? from : Vec3(from + before / (before - behind) * (to - from));
  }

  const SheetPassages& shared_;
  const Paths& paths_;
  std::span<const Pass> passes_;
  int count_ = 0, first_material_ = 0, last_material_ = -1;
  std::deque<std::array<Vec3, 3>> normals_;
  std::vector<LocalHit> hits_, sheets_;
  std::vector<bool> is_image_;
  std::vector<PosedHit> posed_, posed_sheets_;
  const PosedScene* scene_ = nullptr;
  std::vector<Passed> start_, end_;  // by antenna
  Passed inner_;
};

SheetPassages::SheetPassages(const PathPreparer& preparer, double wavelength)
    : preparer_(preparer), wavelength_(wavelength) {
  const Paths& paths = preparer.paths();
  if (paths.passes.empty()) return;
  polarization_ = sheet_polarization(paths);
  of_mesh_.resize(paths.scene->meshes().size());
  for (const Pass& pass : paths.passes) {
    std::optional<Sheet>& sheet = of_mesh_[pass.hit.mesh_id];
    if (sheet) continue;
    const SheetModel model(*paths.scene->node_of(pass.hit.mesh_id).material, kSpeedOfLight / wavelength);
    sheet = Sheet{model, std::nullopt};
    if (paths.passes.size() > kManyPasses) sheet->table.emplace(model);
  }
}

void SheetPassages::apply(std::span<const int64_t> indices, const PosedNodes& nodes, const ChannelSpan& channels) const {
  for (size_t place = 0; place < indices.size(); ++place) {
    if (preparer_.paths().passes_of(static_cast<size_t>(indices[place])).empty()) continue;
    OfPath path(*this, indices[place]);
    for (size_t node = 0; node < nodes.size(); ++node) {
      const size_t num_receivers = nodes.at(node).receivers.size();
      path.pose(nodes.at(node));
      for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
        const size_t of_all = channels.first + channel;
        const auto passed = path.at_channel(of_all / num_receivers, of_all % num_receivers);
        channels.nodes[channel].pass(node, place, passed.delay, passed.field);
      }
    }
  }
}

}  // namespace echopath
