// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_outputs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <system_error>
#include <utility>

#include "edit/find/peak_acceleration.h"
#include "edit/state/measure_constraints.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resolve_moment.h"
#include <nlohmann/json.hpp>

#include "app/edit/edit_json.h"
#include "app/motion/marey_skeleton.h"
#include "core/base/format_text.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/body/mannequin.h"
#include "recordings/edit/annotations_file.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/npz.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

double largest_figure(const edit::Rendered& rendered, const std::string& name) {
  double largest = 0.0;
  for (const edit::OpReport& report : rendered.reports) {
    for (const auto& [figure, value] : report.figures) {
      if (figure == name) largest = std::max(largest, value);
    }
  }
  return largest;
}

/// Returns the look of the body that the last retarget operation put on.
const BodyLook& look_of_result(const EditRecipe& recipe, const EditFiles& files) {
  const BodyLook* look = &files.look;
  for (const EditOp& op : recipe.ops) {
    const auto* retarget = std::get_if<RetargetOp>(&op.parameters);
    if (retarget == nullptr || op.off) continue;
    look = &files.avatars.at(retarget->avatar).look;
  }
  return *look;
}

recordings::NpzContacts npz_contacts(const edit::EditState& state) {
  recordings::NpzContacts out;
  std::vector<std::vector<char>> marks;
  constexpr std::array<HumanBone, 4> kParts{HumanBone::kLeftFoot,
                                            HumanBone::kLeftToes,
                                            HumanBone::kRightFoot,
                                            HumanBone::kRightToes};
  const std::size_t count = state.motion.poses.size();
  for (std::size_t part = 0; part < kParts.size(); ++part) {
    out.names.emplace_back(name(kParts[part]));
    const FootContacts& foot = state.contacts.feet[part / 2];
    marks.push_back(retarget::frame_marks(part % 2 == 0 ? foot.heel : foot.ball, count));
  }
  for (std::size_t t = 0; t < count; ++t) {
    for (const auto& part : marks) {
      out.bears.push_back(static_cast<std::uint8_t>(part[t]));
    }
  }
  return out;
}

/// Writes the files of one result.
class EditWriter {
 public:
  EditWriter(const edit::EditState& state, const BodyLook& look, fs::path stem)
      : state_(state), look_(look), stem_(std::move(stem)) {}

  Status write(const std::vector<MotionFormat>& formats) {
    for (const MotionFormat format : formats) {
      if (const Status ok = write_motion_as(format); !ok) return ok;
    }
    if (!state_.constraints.constraints.empty()) {
      const Status ok = add(".constraints.xml", [&](const fs::path& path) {
        return recordings::write_constraints(path, state_.constraints);
      });
      if (!ok) return ok;
    }
    return add(".annotations.json", [&](const fs::path& path) {
      return recordings::write_annotations(path, annotations());
    });
  }

  std::vector<fs::path>& files() { return files_; }

 private:
  /// The state's annotations, with the events that its contacts show.
  [[nodiscard]] Annotations annotations() const {
    Annotations out = state_.annotations;
    for (Annotation& event : edit::contact_events(state_)) {
      out.notes.push_back(std::move(event));
    }
    std::sort(out.notes.begin(), out.notes.end(), [](const auto& a, const auto& b) {
      return std::pair(a.start_s, a.text) < std::pair(b.start_s, b.text);
    });
    out.notes.erase(std::unique(out.notes.begin(), out.notes.end()), out.notes.end());
    return out;
  }

  template <class Write>
  Status add(const std::string& ending, const Write& write) {
    const fs::path path = stem_.string() + ending;
    if (const Status ok = write(path); !ok) return ok;
    files_.push_back(path);
    return Done{};
  }

  /// Writes nothing if the body allows no file of this kind.
  Status write_motion_as(MotionFormat format) {
    if (!check_result_format(format, state_, look_)) return Done{};
    return add("." + std::string(name(format)), [&](const fs::path& path) {
      return write_result_motion(path, format, state_, look_);
    });
  }

  const edit::EditState& state_;
  const BodyLook& look_;
  fs::path stem_;
  std::vector<fs::path> files_;
};

/// Returns whether a .glb gets marey's mannequin instead of the body's own mesh.
bool has_mannequin(MotionFormat format,
                   const edit::EditState& state,
                   const BodyLook& look) {
  return format == MotionFormat::kGlb && look.file.empty() &&
         is_marey_skeleton(state.motion.skeleton);
}

void check_limit(const std::optional<double>& limit,
                 double value,
                 const std::string& figure,
                 const std::string& unit,
                 const EditFigures& figures,
                 const std::string& next,
                 std::vector<Finding>& out) {
  if (!limit || value <= *limit) return;
  Finding finding = poor_finding("limit",
                                 figures.name,
                                 figure + " is " + format_text("%.3g", value) + " " +
                                     unit + ", limit " + format_text("%.3g", *limit),
                                 next);
  out.push_back(finding.measured(value, *limit, unit));
}

}  // namespace

Status check_result_format(MotionFormat format,
                           const edit::EditState& state,
                           const BodyLook& look) {
  if (has_mannequin(format, state, look)) return Done{};
  return can_hold(format, state.motion.skeleton, look);
}

Status write_result_motion(const fs::path& path,
                           MotionFormat format,
                           const edit::EditState& state,
                           const BodyLook& look) {
  if (format == MotionFormat::kNpz) {
    return recordings::write_npz(
        path, state.motion, {state.uncertainty, npz_contacts(state), {}});
  }
  if (!has_mannequin(format, state, look)) {
    return write_motion_file(path, format, state.motion, look);
  }
  const Proportions proportions = proportions_of(state.motion.skeleton);
  return recordings::write_character(path,
                                     state.motion.skeleton,
                                     recordings::make_mannequin_mesh(proportions),
                                     &state.motion);
}

Status check_output_formats(const EditOutput& output, bool has_markers) {
  if (has_markers && output.marker_formats.empty() && !output.formats.empty()) {
    return bad_usage("--format",
                     "this recipe edits labelled markers, which have no such files",
                     "choose c3d or trc, or leave it out");
  }
  if (!has_markers && output.formats.empty() && !output.marker_formats.empty()) {
    return bad_usage("--format",
                     "c3d and trc are formats of labelled markers, and this recipe edits "
                     "a motion",
                     "choose one of " + motion_extensions() + ", or leave it out");
  }
  return Done{};
}

Status check_no_overwrite(const EditOutput& output,
                          const std::vector<fs::path>& read,
                          const std::vector<std::string>& names,
                          const std::vector<std::string>& endings) {
  std::error_code failed;
  std::set<fs::path> kept(output.kept.begin(), output.kept.end());
  for (const fs::path& path : read) kept.insert(fs::weakly_canonical(path, failed));
  for (const std::string& name : names) {
    for (const std::string& ending : endings) {
      const fs::path result = output.out / (name + ending);
      if (!kept.contains(fs::weakly_canonical(result, failed))) continue;
      return bad_input(result.string(),
                       "is a source, and a result would overwrite it",
                       "choose another folder with --out, or another name in the recipe");
    }
  }
  return Done{};
}

std::vector<std::string> edit_names(const EditRecipe& recipe, std::size_t outputs) {
  if (outputs == 1) return {recipe.name};
  std::vector<std::string> out;
  for (std::size_t i = 0; i < outputs; ++i) {
    out.push_back(recipe.name + "." + std::to_string(i + 1));
  }
  return out;
}

std::vector<EditFigures> measure_edit(const EditRecipe& recipe,
                                      const EditFiles& files,
                                      const edit::Rendered& rendered) {
  const double source_peak = files.source_peak_m_per_s2;
  const auto names = edit_names(recipe, rendered.outputs.size());
  std::vector<EditFigures> out;
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    const edit::EditState& state = rendered.outputs[i];
    EditFigures figures;
    figures.name = names[i];
    figures.frames = state.frame_count();
    figures.duration_s = state.duration_s();
    const edit::SlideFigures slide = edit::measure_slide(state);
    figures.slide_mm = slide.worst_drift_mm;
    figures.slide_cm_per_s = slide.mean_cm_per_s;
    figures.displaced_mm = largest_figure(rendered, "displaced_mm");
    if (source_peak > 0.0) {
      figures.acceleration_ratio =
          edit::peak_acceleration(state.motion).m_per_s2 / source_peak;
    }
    figures.constraint_mm = 1e3 * edit::worst_constraint_m(state);
    for (const edit::FrameLineage& frame : state.lineage.frames) {
      if (frame.trust == Source::kInferred) ++figures.inferred_frames;
    }
    out.push_back(std::move(figures));
  }
  return out;
}

std::vector<Finding> assess_edit(const EditRecipe& recipe,
                                 const std::vector<EditFigures>& figures) {
  const EditLimits& limits = recipe.limits;
  std::vector<Finding> out;
  for (const EditFigures& result : figures) {
    check_limit(limits.slide_mm,
                result.slide_mm,
                "the largest drift of a standing foot",
                "mm",
                result,
                "add the plant operation, or correct the contacts",
                out);
    check_limit(limits.displaced_mm,
                result.displaced_mm,
                "the largest displacement of a joint or marker",
                "mm",
                result,
                "look at edit.json for the operation, and weaken it",
                out);
    check_limit(limits.constraint_mm,
                result.constraint_mm,
                "the largest error of a constraint",
                "mm",
                result,
                "adapt the motion (constrain with adapt = true), or move the target",
                out);
    check_limit(limits.acceleration_ratio,
                result.acceleration_ratio,
                "the peak acceleration against the source's",
                "times",
                result,
                "give the operation a longer blend or overlap",
                out);
  }
  return out;
}

Result<std::vector<fs::path>> write_edit(const EditRecipe& recipe,
                                         const EditFiles& files,
                                         const edit::Rendered& rendered,
                                         const std::vector<EditFigures>& figures,
                                         const EditOutput& output) {
  std::vector<MotionFormat> formats = output.formats;
  if (formats.empty()) {
    formats = {
        MotionFormat::kNpz, MotionFormat::kBvh, MotionFormat::kGlb, MotionFormat::kVrma};
  }
  const BodyLook& look = look_of_result(recipe, files);
  const auto names = edit_names(recipe, rendered.outputs.size());
  std::vector<std::string> endings;
  for (const MotionFormat format : formats) {
    endings.push_back("." + std::string(name(format)));
  }
  const Status spared = check_no_overwrite(output, files.paths, names, endings);
  if (!spared) return spared.error();
  std::vector<fs::path> out;
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    EditWriter writer(rendered.outputs[i], look, output.out / names[i]);
    if (const Status ok = writer.write(formats); !ok) return ok.error();
    std::move(writer.files().begin(), writer.files().end(), std::back_inserter(out));
  }
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  const std::string text =
      edit_json(recipe, files, rendered, figures).dump(1, ' ', false, kReplace) + "\n";
  const fs::path json = output.out / (recipe.name + ".edit.json");
  if (const Status ok = recordings::write_file(json, text); !ok) return ok.error();
  out.push_back(json);
  return out;
}

}  // namespace marey::app
