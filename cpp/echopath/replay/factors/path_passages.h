#pragma once
// Computes what sheets do to waves on the legs of one path, at one node of a time grid after the other.
//
// A leg crosses the plane of the triangle in which it was recorded wherever that is at the time, or the curved surface that
// this stands for. Fields are those of the polarisation by which the record tells modes apart. In a polarised record the
// field of an edge path goes through the sheets between its edges and the antennas as a vector (`through`), and they have no
// part in the factors.
#include <complex>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "echopath/em/layers/sheet_table.h"
#include "echopath/em/polarization/jones.h"
#include "echopath/radar/radar.h"
#include "echopath/replay/posed/local_paths.h"

namespace echopath {

// Holds the sheets that the paths of a record go through.
struct RecordSheets {
  // Raises invalid_argument. The preparer must outlive it.
  RecordSheets(const PathPreparer& preparer, const ChirpSequence& waveform);
  SheetPassage passage(uint32_t mesh_id, double cos_incidence) const {
    const Sheet& sheet = *of_mesh[mesh_id];
    return sheet.table ? sheet.table->passage(cos_incidence) : sheet.model.passage(cos_incidence);
  }

  struct Sheet {
    SheetModel model;
    std::optional<SheetTable> table;  // where there are many passes
  };
  const PathPreparer& preparer;
  double wavelength;                          // m, at the start frequency
  Vec3 polarization = Vec3::UnitZ();          // of the wave, by which its modes are told apart
  std::vector<std::optional<Sheet>> of_mesh;  // by mesh ID; empty where no path passes a sheet
};

class PathPassages {
 public:
  // Holds what sheets do on some legs.
  struct Passed {
    std::complex<double> field = 1.0;
    double delay = 0.0;  // m

    Passed operator*(const Passed& other) const { return {field * other.field, delay + other.delay}; }
  };
  // Names a leg of the path as it was recorded, and the antenna (m, relative to the origin) at its end or behind mirrors.
  struct LegOfAntenna {
    int leg;
    Vec3 antenna;
    bool is_forward;  // the wave travels from the transmitter's end toward the receiver's
  };

  // The sheets must outlive it.
  PathPassages(const RecordSheets& sheets, int64_t path);
  void pose(const PosedScene& scene);
  // Returns what all sheets do between two antennas.
  Passed at_channel(size_t transmitter, size_t receiver) const;
  // Returns what the sheets of one leg make of the field vector of a wave.
  FieldVector through(const LegOfAntenna& at, FieldVector field) const;

 private:
  struct Ends {
    Vec3 transmitter, receiver;
  };
  struct Crossing {
    Vec3 normal;  // unit, of the sheet where the leg crosses it
    SheetPassage passage;
  };
  static size_t at(int k) { return static_cast<size_t>(k); }
  // Returns the passes [begin, end) on a leg.
  std::pair<size_t, size_t> passes_on(int leg) const;
  bool is_of_field(int leg) const;
  Passed passed(int first, int last, const Ends& ends) const;
  Passed passed_on_leg(int leg, const Ends& ends) const;
  Crossing crossing(size_t pass, const Vec3& from, const Vec3& direction) const;
  Vec3 normal_at(size_t pass, const Vec3& from, const Vec3& direction) const;
  std::pair<Vec3, Vec3> ends_of_leg(int leg, const Ends& ends) const;

  const RecordSheets& shared_;
  const Paths& paths_;
  std::span<const Pass> passes_;
  int count_ = 0, first_material_ = 0, last_material_ = -1;
  int first_edge_ = -1, num_edges_ = 0;  // hits on edges whose fields are followed
  std::deque<std::array<Vec3, 3>> normals_;
  std::vector<LocalHit> hits_, sheets_;
  std::vector<bool> is_image_;
  std::vector<PosedHit> posed_, posed_sheets_;
  const PosedScene* scene_ = nullptr;
  std::vector<Passed> start_, end_;  // by antenna
  Passed inner_;
};

}  // namespace echopath
