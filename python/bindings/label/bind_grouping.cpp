#include "label/grouping.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "call/run_job.h"
#include "echopath/label/objects/appearing.h"
#include "echopath/label/objects/families.h"
#include "echopath/label/objects/visibility.h"
#include "label/named_selections.h"
#include "scene/scene_geometry.h"
#include "values/array.h"

namespace echopath::bindings {
namespace {

using Objects = std::vector<std::pair<std::string, std::vector<std::string>>>;

py::object text_key(const std::string& name) { return py::str(name); }

KeyedGrouping selections_grouping(const SelectionPairs& parts) {
  return {by_selections(named_selections(parts)), &text_key, [parts] { return py::make_tuple("selections", parts); }};
}

// Remembers the families that it meets, also those of later records.
KeyedGrouping families_grouping(SurfaceMap surfaces) {
  auto known = std::make_shared<std::map<std::string, Family>>();
  const auto recipe = [surfaces] {
    return py::make_tuple("families", py::make_tuple(surfaces.names, surfaces.num_objects, to_numpy(surfaces.of_mesh)));
  };
  Grouping rule = [surfaces = std::move(surfaces), known](const Paths& paths, Job* job) {
    const Families found = find_families(paths, surfaces, job);
    for (const Family& family : found.families) known->try_emplace(family.key(), family);
    return found.partition();
  };
  return {std::move(rule), [known](const std::string& name) { return py::cast(known->at(name)); }, recipe};
}

SurfaceMap surfaces_of_state(const py::tuple& state) {
  SurfaceMap surfaces{state[0].cast<std::vector<std::string>>(), state[1].cast<uint32_t>(),
                      as_vector<uint32_t>(state[2], "of_mesh")};
  const size_t count = surfaces.names.size();
  require(surfaces.num_objects <= count, "num_objects", "must be the number of some of the names", surfaces.num_objects);
  for (const uint32_t surface : surfaces.of_mesh)
    require(surface < count, "of_mesh", "must be below the number of names", surface);
  return surfaces;
}

py::object batch_key(const std::string& name) {
  if (name == kAllBatches) return py::make_tuple(py::none(), "coherent");
  const size_t number = name.find(' ') + 1, kind = name.rfind(' ') + 1;
  return py::make_tuple(std::stoi(name.substr(number)), name.substr(kind));
}

KeyedGrouping all_of(const std::vector<KeyedGrouping>& groupings) {
  std::vector<Grouping> rules;
  for (const KeyedGrouping& grouping : groupings) rules.push_back(grouping.rule);
  const auto key_of = [groupings](const std::string& name) {
    py::tuple key(groupings.size());
    size_t begin = 0;
    for (size_t i = 0; i < groupings.size(); ++i) {
      const size_t end = name.find(kBetweenNames, begin);
      key[i] = groupings[i].key_of(name.substr(begin, end - begin));
      begin = end + 1;
    }
    return py::object(key);
  };
  const auto recipe = [groupings] { return py::make_tuple("all_of", groupings); };
  return {by_all(std::move(rules)), key_of, recipe};
}

KeyedGrouping batches_grouping() {
  return {by_batches(), &batch_key, [] { return py::make_tuple("batches", py::none()); }};
}

KeyedGrouping grouping_of_recipe(const py::tuple& recipe) {
  const auto kind = recipe[0].cast<std::string>();
  if (kind == "selections") return selections_grouping(recipe[1].cast<SelectionPairs>());
  if (kind == "families") return families_grouping(surfaces_of_state(recipe[1].cast<py::tuple>()));
  if (kind == "all_of") return all_of(recipe[1].cast<std::vector<KeyedGrouping>>());
  require(kind == "batches", "grouping", "must be 'selections', 'families', 'all_of' or 'batches'", "'" + kind + "'");
  return batches_grouping();
}

SurfaceMap surfaces_of(const Scene& scene, const Objects& objects) {
  std::vector<NamedGlobs> named;
  for (const auto& [name, globs] : objects) named.push_back({name, globs});
  return map_surfaces(scene, named);
}

SurfaceMap surfaces_of(const Paths& paths, const std::optional<Objects>& objects) {
  return objects ? surfaces_of(*paths.scene, *objects) : map_surfaces(paths);
}

py::tuple families_of(const Paths& paths, const std::optional<Objects>& objects) {
  const SurfaceMap surfaces = surfaces_of(paths, objects);
  Families found = run_job("families", py::none(), [&](Job& job) { return find_families(paths, surfaces, &job); });
  const std::vector<std::string> names(surfaces.names.begin(), surfaces.names.begin() + surfaces.num_objects);
  return py::make_tuple(names, found.families, numpy_take(std::move(found.family_of_path)), families_grouping(surfaces));
}

py::tuple visibility_tuple(const VisibilityFromEnd& seen) {
  py::dict occluders;
  for (const auto& [name, share] : seen.occluders) occluders[py::str(name)] = share;
  return py::make_tuple(seen.visible_share, occluders, seen.in_view, seen.distance, seen.solid_angle);
}

py::list sight_list(const std::vector<ObjectVisibility>& seen) {
  py::list out;
  for (const ObjectVisibility& object : seen) {
    out.append(py::make_tuple(object.name, py::tuple(py::cast(object.mesh_ids)), visibility_tuple(object.transmitter),
                              visibility_tuple(object.receiver)));
  }
  return out;
}

py::list visibility_of(Scene scene, const Radar& radar, const std::optional<Objects>& objects, std::optional<double> time,
                       int num_directions, const py::object& progress) {
  const double at = time.value_or(radar.middle_of_frame(0.0));
  return sight_list(run_job("visibility", progress, [&](Job& job) {
    radar.validate();
    const SurfaceMap surfaces = objects ? surfaces_of(scene, *objects) : map_surfaces(scene, at, radar);
    return visibility(scene, radar, surfaces, {at, num_directions}, &job);
  }));
}

// Of the objects that families_of finds, whatever the radar, at the time of the trace where there is no other. The geometry
// of the trace serves where it is kept: it is brought to that time, which costs what moves.
py::list visibility_in_trace(const Paths& paths, const Radar& radar, const std::optional<Objects>& objects,
                             std::optional<double> time, int num_directions, const py::object& progress) {
  const SurfaceMap surfaces = surfaces_of(paths, objects);
  const VisibilitySettings settings{time.value_or(paths.frame.trace_time), num_directions};
  const std::shared_ptr<KeptGeometry> kept = geometry_of(paths.scene);
  return sight_list(run_job("visibility", progress, [&](Job& job) {
    return visibility(*paths.scene, radar, surfaces, settings, &job, kept.get());
  }));
}

// Of the objects named, those that may_appear at shares of the frame.
std::vector<std::string> may_appear_in_frame(const Paths& paths, const Radar& radar, const std::optional<Objects>& objects,
                                             const std::vector<std::string>& hidden, const std::vector<double>& shares,
                                             double hidden_share) {
  const SurfaceMap surfaces = surfaces_of(paths, objects);
  AppearingSettings settings;
  settings.time = paths.frame.trace_time;
  settings.hidden_share = hidden_share;
  for (const double share : shares) settings.others.push_back(paths.frame.start_time + share * radar.frame_duration());
  std::vector<uint32_t> asked;
  for (uint32_t i = 0; i < surfaces.num_objects; ++i) {
    if (std::ranges::find(hidden, surfaces.names[i]) != hidden.end()) asked.push_back(i);
  }
  const std::shared_ptr<KeptGeometry> kept = geometry_of(paths.scene);
  const auto found = run_job("visibility", py::none(), [&](Job& job) {
    return may_appear(*paths.scene, radar, surfaces, asked, settings, &job, kept.get());
  });
  std::vector<std::string> names;
  for (const uint32_t object : found) names.push_back(surfaces.names[object]);
  return names;
}

py::dict meshes_by_name(const SurfaceMap& surfaces) {
  py::dict meshes;
  for (uint32_t i = 0; i < surfaces.num_objects; ++i) meshes[py::str(surfaces.names[i])] = surfaces.meshes_of(i);
  return meshes;
}

void bind_visibility(py::module_& m) {
  m.def(
      "check_objects", [](const Scene& scene, const Objects& objects) { surfaces_of(scene, objects); }, py::arg("scene"),
      py::arg("objects"), "Raises what find_families would for objects [(name, [glob, ...]), ...].");
  m.def(
      "meshes_of_objects",
      [](const Scene& scene, const Objects& objects) { return meshes_by_name(surfaces_of(scene, objects)); },
      py::arg("scene"), py::arg("objects"),
      "{name: IDs of its meshes} of objects [(name, [glob, ...]), ...]; raises what find_families would.");
  m.def(
      "meshes_of_usual_objects",
      [](const Scene& scene, const Radar& radar, double time) {
        radar.validate();
        return meshes_by_name(map_surfaces(scene, time, radar));
      },
      py::arg("scene"), py::arg("radar"), py::arg("time"),
      "{name: IDs of its meshes} of the objects that find_families has where none are named, at a time in s.");
  m.def("visibility_in_trace", &visibility_in_trace, py::arg("paths"), py::arg("radar"), py::arg("objects"), py::arg("time"),
        py::arg("num_directions"), py::arg("progress"),
        "As visibility, of the objects that find_families has for a trace; time: s, None: that of the trace.");
  m.def(
      "remember_geometry",
      [](const Paths& paths, const std::shared_ptr<KeptGeometry>& kept) {
        if (geometry_of(paths.scene)) return false;
        remember_geometry(paths.scene, kept);
        return true;
      },
      py::arg("paths"), py::arg("kept"),
      "Has visibility_in_trace and may_appear_in_frame keep geometry there, unless the trace kept its own. Returns "
      "whether.");
  m.def("may_appear_in_frame", &may_appear_in_frame, py::arg("paths"), py::arg("radar"), py::arg("objects"),
        py::arg("hidden"), py::arg("shares"), py::arg("hidden_share"),
        "Of the objects named in hidden, those that may be in sight at shares of the frame: the others are not.");
  m.def("visibility", &visibility_of, py::arg("scene"), py::arg("radar"), py::arg("objects"), py::arg("time"),
        py::arg("num_directions"), py::arg("progress"),
        "[(name, mesh IDs, of the transmitter, of the receiver), ...], the last two each a tuple of the fields of "
        "echopath.VisibilityFromEnd.");
}

void bind_family(py::module_& m) {
  const auto via = [](const Family& self) { return py::tuple(py::cast(self.via)); };
  const auto state = [via](const Family& self) {
    return py::make_tuple(self.object, self.ghost_type, self.order, via(self));
  };
  py::class_<Family> family(m, "Family", R"(Paths of one object that went the same way.

After the Radar Ghost Dataset (Kraus et al. 2021).

object: name, "" for the background: paths that touch no object
ghost_type: 0 for real echoes (and the background), 1 for ghosts whose last bounce is on the object, 2 on something else
order: number of bounces; hits that follow each other on one object are one. 1 for real echoes, 0 for the background
via: names of what mirrored it, each once, in the order of the first bounce there
Raises TypeError or ValueError naming the argument.)");
  define_init(
      family,
      [](Arg<"object", Text> object, Arg<"ghost_type", Whole<0, 2>> ghost_type, Arg<"order", Count> order,
         Arg<"via", List<Text>> surfaces) { return Family{*object, *ghost_type, *order, *surfaces}; },
      py::arg("object"), py::arg("ghost_type"), py::arg("order"), py::arg("via"));
  family.def_readonly("object", &Family::object, "name of the object, \"\" for the background")
      .def_readonly("ghost_type", &Family::ghost_type, "0: real echo or background; 1, 2: of a ghost")
      .def_readonly("order", &Family::order, "number of bounces; 0: background")
      .def_property_readonly("via", via, "tuple of the names of what mirrored it")
      .def_property_readonly("class_code", &Family::class_code,
                             R"(Label of the Radar Ghost Dataset without the object's class, to which 1000 C is to be added
(C: 1 pedestrian, 2 cyclist, 3 car, 4 large vehicle, 5 motorcycle): 111 real, 112 type 1 of order 2, 122 type 2 of order
2, 124 type 2 of order 3; 100 every other ghost, which the dataset leaves undecided; 0 background (no class).)")
      .def_property_readonly(
          "is_ghost", [](const Family& self) { return self.ghost_type > 0; }, "neither real nor background")
      .def(
          "__eq__", [](const Family& a, const Family& b) { return a == b; }, py::is_operator())
      .def("__hash__", [state](const Family& self) { return py::hash(state(self)); })
      .def("__str__", &Family::name)
      .def("__repr__", [](const Family& self) { return "<Family " + self.name() + ">"; })
      .def(py::pickle(state, [](const py::tuple& saved) { return py::type::of<Family>()(*saved).cast<Family>(); }));
}

}  // namespace

void bind_grouping(py::module_& m) {
  bind_family(m);
  bind_visibility(m);
  py::class_<KeyedGrouping>(m, "Grouping", "A rule that sorts the paths of any record of a scene into parts, for decompose.")
      .def_static("selections", &selections_grouping, py::arg("parts"),
                  "parts: [(name, selection), ...]; the first that takes a path has it. Keys: names, \"other\" last.")
      .def_static("batches", &batches_grouping,
                  "Keys: (batch, \"coherent\") and (batch, \"diffuse\"); last (None, \"coherent\"), paths by images, which "
                  "stand in each batch's estimate in full.")
      .def_static("all_of", &all_of, py::arg("groupings"), "Combinations that occur. Keys: tuples of keys.")
      .def(py::pickle([](const KeyedGrouping& self) { return self.recipe(); }, &grouping_of_recipe));
  m.def("find_families", &families_of, py::arg("paths"), py::arg("objects"),
        R"(The family of each path.

objects: [(name, [glob, ...]), ...] or None for the children of the scene's root that do not surround the antenna
Returns the names of the objects, the families that occur (background last), uint32 [P] indices into them, and the
Grouping by them.)");
}

}  // namespace echopath::bindings
