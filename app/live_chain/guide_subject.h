// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/live_instant.h"
#include "live/page/page_request.h"
#include "live/page/page_wizard.h"
#include "reconstruct/subject/fit_subject.h"

namespace marey::app {

/// What is known before anybody is guided.
struct GuideSetup {
  std::vector<Camera> cameras;
  std::vector<double> rms_px;  ///< By camera: of its calibration.
  reconstruct::SubjectPrior prior;
  FrameRate rate;
};

struct GuideOptions {
  double stand_s = 2.5;
  /// Twice that at the most, when a part of the body was not seen well.
  double move_s = 20.0;
};

/// What cameras saw of the two steps, as fit_subject() takes it: without shrinkage.
struct GuideMaterial {
  std::vector<CameraDetections> standing;
  std::vector<CameraDetections> moving;
};

/// The steps in which a person is measured before live cameras: stand still, move every
/// joint, wait for the fit, look at how good it is. What has to be said and shown stands
/// in ui_state(); everything else is for others to do: to hand in what was seen and what was
/// asked for, to solve what take_material() gives, to keep the body once it is accepted.
///
/// No threads, no clock but the instants' own: same calls, same answers. While a step
/// looks on, what it keeps is allocated, at most 2 * move_s of it.
///
/// - Stand: counts while the hips and most parts of the body are seen; begins anew when
///   somebody moves by more than some centimetres. Goes on to move by itself.
/// - Move: counts while the hips are seen, and waits for every part of the body that wears
///   tags to be seen twice at once, by two cameras or of two tags. Goes on to solve by
///   itself.
class SubjectGuide {
 public:
  /// Preconditions: cameras and rms_px of one number, at least one tag.
  explicit SubjectGuide(GuideSetup setup, const GuideOptions& options = {});

  /// What a page or a program asks for; the answer is why not, or nullopt.
  [[nodiscard]] std::optional<std::string> act(live::WizardAction action);
  /// Looks at one instant. Its views' cameras are positions in setup.cameras.
  void see(const LiveInstant& instant);
  /// No instant will follow: solves what there is if that is enough, else fails.
  void end();

  /// What is to be solved: once, after the step has become kSolve.
  [[nodiscard]] std::optional<GuideMaterial> take_material();
  /// What came of it. Ignored unless the step is kSolve.
  void finish(const Result<reconstruct::SubjectFit>& fit);
  /// Back to kDone, saying why, when what was accepted could not be kept.
  void refuse_acceptance(const std::string& why);

  [[nodiscard]] const live::PageWizard& ui_state() const { return ui_state_; }
  [[nodiscard]] live::WizardStep step() const { return ui_state_.step; }
  /// The step is kDone, and nothing of its quality is poor.
  [[nodiscard]] bool is_good() const;

 private:
  void start();
  void begin_move();
  void begin_solve();
  void fail(const std::string& why);
  void look(const LiveInstant& instant);
  void add_standing(const LiveInstant& instant);
  void move(const LiveInstant& instant);
  void keep(const LiveInstant& instant, std::vector<CameraDetections>& out) const;
  void count_time(Timestamp time);
  [[nodiscard]] bool has_moved(const LiveInstant& instant);
  [[nodiscard]] int sightings_of(HumanBone part) const;
  [[nodiscard]] std::set<HumanBone> parts_of(const std::vector<int>& counts,
                                             int least) const;
  [[nodiscard]] std::string missing_parts(const std::set<HumanBone>& there) const;
  [[nodiscard]] std::vector<CameraDetections> nothing_seen() const;

  GuideSetup setup_;
  GuideOptions options_;
  std::set<HumanBone> parts_;  ///< Those that wear tags.
  live::PageWizard ui_state_;
  GuideMaterial material_;
  bool has_material_ = false;
  double counted_s_ = 0.0;  ///< Of this step.
  std::optional<Timestamp> last_;
  bool was_restless_ = false;
  std::vector<std::vector<int>> cells_;  ///< By camera and cell: tags seen there.
  std::vector<int> now_;    ///< By tag: cameras that see it in this instant.
  std::vector<int> twice_;  ///< By tag: instants in which its part was seen twice.
  /// By camera and tag: where its centre was as the standing began. [px]
  std::vector<std::vector<std::optional<glm::dvec2>>> stood_px_;
  std::vector<double> shifts_;
};

}  // namespace marey::app
