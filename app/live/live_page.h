// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/live/live_run.h"
#include "app/live/thumbnail_requests.h"
#include "app/live_chain/live_balance.h"
#include "app/live_chain/live_health.h"
#include "app/view/page_server.h"
#include "core/base/stopwatch.h"
#include "live/page/page_frame.h"
#include "live/page/page_scene.h"
#include "live/page/page_status.h"
#include "recordings/takes/jpeg_encoder.h"

namespace marey::app {

/// Shows a live run in browsers: the performer with its uncertainty, the skinned avatars
/// next to it, the handles of the first avatar, the cameras with their thumbnails and
/// tags, and the status of cameras, outputs and subject. A slow browser skips frames and
/// never delays the run.
class LivePage final : public LiveWatcher {
 public:
  /// Starts the server with the scene of this run. `wizard` performs calibrations; it may
  /// be null and must outlive the page. Errors: those of start_page(); a skin file cannot
  /// be read.
  [[nodiscard]] static Result<std::unique_ptr<LivePage>> open(
      const PageServerOptions& options,
      const OpenedLive& live,
      const Skeleton& performer,
      LiveWizard* wizard);

  [[nodiscard]] const PageServer& server() const { return page_; }
  [[nodiscard]] bool wants_thumbnails() const override { return thumbnails_.any(); }
  void take_requests(LiveRequests& requests) override;
  void on_body(const Body& body, const Skeleton& performer) override;
  std::optional<bool> record_request() override {
    return std::exchange(record_request_, {});
  }
  void on_frame(const LiveInstant& instant, const LiveResult& result) override;
  void on_thumbnail(std::size_t camera,
                    std::span<const std::byte> pixels,
                    int width_px,
                    int height_px,
                    std::span<const TagDetection> tags) override;
  void on_status(const LiveStatistics& figures,
                 const LiveTimes& recent,
                 reconstruct::TrackState state) override;

 private:
  explicit LivePage(PageServer page) : page_(std::move(page)) {}
  [[nodiscard]] Status make_scene(const OpenedLive& live, const Skeleton& performer);
  /// Reply to a request of a page; an empty text means no reply.
  struct Answer {
    std::string text;
    std::string about{};  ///< Subject of the error, see error_json().
  };
  [[nodiscard]] Answer answer(const std::string& text,
                              live::ClientId from,
                              LiveRequests& requests);
  [[nodiscard]] std::string ask(HandleRequest request, LiveRequests& requests);
  void watch(const Body& body);
  void make_balance();
  void update_balance(const LiveInstant& instant, const LiveResult& result);
  void pose_bodies(const LiveResult& result);
  void publish_handles(std::span<const HandleState> handles);
  void show_wizard();
  void note(reconstruct::TrackState state, const LiveStatistics& figures);

  PageServer page_;
  LiveWizard* wizard_ = nullptr;
  live::WizardStep shown_step_ = live::WizardStep::kIdle;
  bool has_body_ = false;
  std::optional<bool> record_request_;  ///< true: start; false: stop.
  live::PageScene scene_;
  std::vector<live::PageFigure> figures_;
  std::optional<LiveBalance> balance_;
  std::vector<std::optional<recordings::JpegEncoder>> encoders_;  ///< By camera.
  std::vector<int> tags_seen_;  ///< By camera: tags in its newest picture.
  WornSegments worn_;
  std::vector<std::string> body_warnings_;
  std::vector<JointUncertainty> uncertainty_;      ///< Newest of the performer.
  std::vector<LiveCameraFigures> cameras_before_;  ///< At the last status.
  std::vector<OutputCounts> outputs_before_;       ///< At the last status.
  std::vector<live::ReceivedText> texts_;
  std::string bytes_;
  std::vector<std::string> notes_;
  std::optional<Timestamp> first_;
  std::optional<std::int64_t>
      last_tracked_;  ///< Number of the last instant with the body tracked.
  std::optional<reconstruct::TrackState> state_;
  std::uint32_t frame_ = 0;
  std::uint32_t handles_published_ = 0;  ///< Frame of the last publication.
  long frames_before_ = 0;
  double seconds_before_ = 0.0;
  Stopwatch since_start_;
  ThumbnailRequests thumbnails_;
};

}  // namespace marey::app
