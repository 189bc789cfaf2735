// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/stage/live/stage_session.h"
#include "app/view/page_server.h"
#include "core/base/result.h"
#include "live/page/page_frame.h"
#include "live/web/received_text.h"

namespace marey::app {

/// The browser page of a scene that runs live: all bodies, the targets as handles, the
/// figures, play, pause and restart. A slow browser skips frames and never delays the
/// scene.
class StagePage {
 public:
  /// Starts the server with the scene. Errors: those of start_page().
  [[nodiscard]] static Result<StagePage> open(const PageServerOptions& options,
                                              const StageSession& session);

  [[nodiscard]] const PageServer& server() const { return page_; }

  /// Carries out the requests of all pages. An invalid request is answered with its error
  /// and has no effect.
  void answer(StageSession& session, Timestamp now);
  /// Sends the present postures and targets. `now` is on the steady clock.
  void publish_frame(const StageSession& session, Timestamp now);
  /// Sends the targets alone, for a scene that is paused.
  void publish_targets(const StageSession& session);
  /// Sends the state and the figures.
  void publish_run(StageSession& session);

 private:
  explicit StagePage(PageServer page) : page_(std::move(page)) {}

  PageServer page_;
  std::vector<live::PageFigure> figures_;
  std::vector<live::ReceivedText> texts_;
  std::string bytes_;
  std::uint32_t frame_ = 0;
  double frame_s_ = 0.0;
};

}  // namespace marey::app
