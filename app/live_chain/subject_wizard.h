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

/// Input of a calibration of a subject.
struct WizardSetup {
  std::vector<Camera> cameras;
  std::vector<double> rms_px;  ///< By camera: calibration residual.
  reconstruct::SubjectPrior prior;
  FrameRate rate;
};

struct WizardOptions {
  double stand_s = 2.5;
  /// Duration of the moving step; up to twice as long if a part was not seen well.
  double move_s = 20.0;
};

/// Detections of the two steps, in the form of fit_subject(): without tag shrinkage.
struct WizardMaterial {
  std::vector<CameraDetections> standing;
  std::vector<CameraDetections> moving;
};

/// State machine of the live calibration of a subject: stand still, move every joint,
/// wait for the fit, review its quality. ui_state() is the state for the UI. The class
/// does no I/O: the caller supplies instants and actions, solves the data of
/// take_material() and stores the accepted body.
///
/// Uses no threads and no clock except the times of the instants, so the same calls give
/// the same results. The detections of a step are allocated, for at most 2 * move_s.
///
/// - Stand: time counts while the hips and most parts of the body are visible. Restarts
///   if the subject moves by more than some centimetres. Continues to Move automatically.
/// - Move: time counts while the hips are visible. The step waits until every part of the
///   body with tags was seen twice at once, by two cameras or with two tags. Continues to
///   Solve automatically.
class SubjectWizard {
 public:
  /// Preconditions: as many cameras as rms_px, at least one tag.
  explicit SubjectWizard(WizardSetup setup, const WizardOptions& options = {});

  /// Performs an action of a page or program. Returns the reason if it is rejected, else
  /// nullopt.
  [[nodiscard]] std::optional<std::string> act(live::WizardAction action);
  /// Processes one instant. The cameras of its views are indices into setup.cameras.
  void process(const LiveInstant& instant);
  /// Ends the input. Continues to the solve if the detections suffice, else fails.
  void end();

  /// Returns the data to be solved, once, after the step has become kSolve.
  [[nodiscard]] std::optional<WizardMaterial> take_material();
  /// Sets the result of the solve. Ignored unless the step is kSolve.
  void finish(const Result<reconstruct::SubjectFit>& fit);
  /// Returns to kDone with the reason `why` if the accepted body could not be stored.
  void refuse_acceptance(const std::string& why);

  [[nodiscard]] const live::PageWizard& ui_state() const { return ui_state_; }
  [[nodiscard]] live::WizardStep step() const { return ui_state_.step; }
  /// Returns true if the step is kDone and no quality value is poor.
  [[nodiscard]] bool is_good() const;

 private:
  void start();
  void begin_move();
  void begin_solve();
  void fail(const std::string& why);
  void update_visible_tags(const LiveInstant& instant);
  void add_standing(const LiveInstant& instant);
  void move(const LiveInstant& instant);
  void keep(const LiveInstant& instant, std::vector<CameraDetections>& out) const;
  void count_time(Timestamp time);
  [[nodiscard]] bool has_moved(const LiveInstant& instant);
  [[nodiscard]] int sightings_of(HumanBone part) const;
  [[nodiscard]] std::set<HumanBone> parts_of(const std::vector<int>& counts,
                                             int min_count) const;
  [[nodiscard]] std::string missing_parts(const std::set<HumanBone>& there) const;
  [[nodiscard]] std::vector<CameraDetections> nothing_seen() const;

  WizardSetup setup_;
  WizardOptions options_;
  std::set<HumanBone> parts_;  ///< Parts with tags.
  live::PageWizard ui_state_;
  WizardMaterial material_;
  bool has_material_ = false;
  double counted_s_ = 0.0;  ///< Counted time of this step.
  std::optional<Timestamp> last_;
  bool was_restless_ = false;
  std::vector<std::vector<int>> cells_;  ///< By camera and cell: tags seen there.
  std::vector<int> now_;                 ///< By tag: cameras that see it in this instant.
  std::vector<int> twice_;  ///< By tag: instants in which its part was seen twice.
  /// By camera and tag: its centre when the subject began to stand still. [px]
  std::vector<std::vector<std::optional<glm::dvec2>>> stood_px_;
  std::vector<double> shifts_;
};

}  // namespace marey::app
