// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/calibrate_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <variant>

#include "app/process/stand_on_floor.h"
#include "app/shell/lens_words.h"
#include "calib/rig/calibrate_cameras.h"
#include "calib/rig/calibrate_wand.h"
#include "recordings/session/calibration_file.h"

namespace marey::app {
namespace {

using recordings::ClockChoice;
using Lenses = std::vector<std::optional<Intrinsics>>;

std::string size_of(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px);
}

/// Reads the lenses of the file that the session names. One entry per camera, nullopt for
/// a camera that the file does not contain.
Result<Lenses> given_lenses(const recordings::Session& session,
                            const std::vector<CameraDetections>& waved,
                            std::vector<std::string>& notes) {
  Lenses lenses(session.cameras.size());
  if (!session.calibration.lenses) return lenses;
  const auto& file = *session.calibration.lenses;
  const auto known = recordings::read_lenses(file);
  if (!known) return known.error();
  std::string found;
  for (std::size_t c = 0; c < lenses.size(); ++c) {
    const std::string& name = session.cameras[c];
    const auto camera = std::find_if(known->cameras.begin(),
                                     known->cameras.end(),
                                     [&](const Camera& k) { return k.name == name; });
    if (camera == known->cameras.end()) continue;
    const Intrinsics& k = camera->intrinsics;
    if (k.width_px != waved[c].width_px || k.height_px != waved[c].height_px) {
      return bad_input(file.string(),
                       "the lens of camera \"" + name + "\" is for pictures of " +
                           size_of(k.width_px, k.height_px) + ", and those of " +
                           waved[c].source + " are " +
                           size_of(waved[c].width_px, waved[c].height_px),
                       "give a calibration of this size, or leave out `lenses`");
    }
    lenses[c] = k;
    found += (found.empty() ? "" : ", ") + name;
  }
  if (found.empty()) {
    return bad_input(
        session.file.string() + ":" + std::to_string(session.calibration.lenses_line),
        file.string() + " contains no lens of a camera of the session",
        "use the same camera names in both files");
  }
  notes.push_back("the lenses of " + found + " are taken from " + file.string() +
                  " as they are");
  return lenses;
}

calib::CalibrateOptions options_for(const recordings::CalibrationChoices& choices,
                                    Lenses lenses) {
  calib::CalibrateOptions options;
  options.lens = choices.lens.value_or(LensModel::kBrownConrady);
  options.choose_lens = !choices.lens;
  options.lenses = std::move(lenses);
  options.choose_clocks = choices.clocks == ClockChoice::kAuto;
  options.solve_drifts = choices.clocks == ClockChoice::kDrifts;
  options.solve_offsets = choices.clocks == ClockChoice::kOffsets || options.solve_drifts;
  options.solve_line_delays = choices.line_delays;
  options.max_offset_s = choices.max_offset_s;
  options.find_warp = choices.warp;
  options.cross_validate = choices.cross_validate;
  return options;
}

template <class... Values>
std::string text(const char* pattern, Values... values) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, values...);
  return buffer.data();
}

/// Adds a note about the chosen lens model, if a camera has no given lens.
void add_lens_note(const recordings::Session& session,
                   const Lenses& given,
                   const calib::CalibratedRig& rig,
                   std::vector<std::string>& notes) {
  if (session.calibration.lens) return;
  const auto found = std::find(given.begin(), given.end(), std::nullopt);
  if (found == given.end()) return;
  const auto c = static_cast<std::size_t>(found - given.begin());
  notes.push_back("chosen lens model: " +
                  std::string(lens_word(rig.cameras[c].intrinsics.lens)));
}

/// Adds notes about clocks, line delays, lens, bend of the board and cross-validation.
void add_solution_notes(const recordings::Session& session,
                        const Lenses& given,
                        const calib::CalibratedRig& rig,
                        std::vector<std::string>& notes) {
  std::string clocks;
  std::string delays;
  for (std::size_t c = 0; c < rig.clocks.size(); ++c) {
    const calib::SolvedClock& clock = rig.clocks[c];
    const std::string& name = session.cameras[c];
    if (clock.offset_sigma_s > 0.0) {
      clocks +=
          (clocks.empty() ? "" : ", ") + name +
          text(" %+.1f ms (+- %.1f)", 1e3 * clock.offset_s, 1e3 * clock.offset_sigma_s);
      if (clock.drift_sigma > 0.0) clocks += text(" and %+.0f ppm", 1e6 * clock.drift);
    }
    if (clock.line_delay_sigma_s > 0.0) {
      delays += (delays.empty() ? "" : ", ") + name +
                text(" %.1f us (+- %.1f)",
                     1e6 * clock.line_delay_s,
                     1e6 * clock.line_delay_sigma_s);
    }
  }
  if (!clocks.empty()) {
    notes.push_back("the cameras' clocks in the calibration, against " +
                    session.cameras.front() + "'s: " + clocks +
                    (session.calibration.clocks == ClockChoice::kAuto
                         ? ". The clocks differ, and the calibration corrects this. The "
                           "videos of motions must start within two frames of each other"
                         : ""));
  }
  if (!delays.empty()) {
    notes.push_back("delay from one picture row to the next: " + delays);
  }
  add_lens_note(session, given, rig, notes);
  if (session.calibration.warp) {
    notes.push_back(rig.warp_m ? text("the board is bent: its edges rise by %.1f mm "
                                      "along x, %.1f mm along y, %.1f mm across",
                                      1e3 * (*rig.warp_m)[0],
                                      1e3 * (*rig.warp_m)[1],
                                      1e3 * (*rig.warp_m)[2])
                               : std::string("the board is flat: no bend is measurable"));
  }
  if (rig.cross_validation) {
    notes.push_back(
        text("cross-validation: reprojection error %.2f px in frames that "
             "were held out, %.2f px in frames that were used",
             rig.cross_validation->held_out_rms_px,
             rig.cross_validation->seen_rms_px));
  } else if (session.calibration.cross_validate) {
    notes.push_back(
        "cross-validation failed: half of the frames are too few for a calibration. "
        "The error in frames that are held out is unknown");
  }
}

Result<calib::CalibratedRig> solve(const recordings::Session& session,
                                   const CalibrationSights& sights,
                                   Lenses lenses,
                                   const Progress& progress) {
  auto options = options_for(session.calibration, std::move(lenses));
  options.progress = progress;
  const auto* wand = std::get_if<Wand>(&session.target);
  if (wand == nullptr) {
    return calib::calibrate_cameras(
        session.cameras, sights.waved, sights.floor, session.target, options);
  }
  calib::WandOptions wand_options;
  static_cast<calib::RigOptions&>(wand_options) = options;
  auto calibrated =
      calib::calibrate_wand(session.cameras, sights.waved, *wand, wand_options);
  if (!calibrated) return calibrated.error();
  return std::move(calibrated->rig);
}

}  // namespace

Result<SessionRig> calibrate_session(const recordings::Session& session,
                                     const CalibrationSights& sights,
                                     const Progress& progress) {
  SessionRig out;
  auto lenses = given_lenses(session, sights.waved, out.notes);
  if (!lenses) return lenses.error();
  auto rig = solve(session, sights, *lenses, progress);
  if (!rig) return rig.error();
  out.rig = std::move(*rig);
  add_solution_notes(session, *lenses, out.rig, out.notes);
  const bool is_wand = std::holds_alternative<Wand>(session.target);
  if (is_wand || sights.floor.empty()) {
    const auto note = stand_on_floor(session, sights.floor, sights.standing, out.rig);
    if (!note) return note.error();
    out.notes.push_back(*note);
  }
  out.has_floor = !sights.floor.empty() || !sights.standing.empty();
  return out;
}

}  // namespace marey::app
