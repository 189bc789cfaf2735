// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_page.h"

#include <utility>

#include "live/page/page_run.h"
#include "live/page/page_scene.h"
#include "live/page/page_status.h"

namespace marey::app {
namespace {

live::PageScene page_scene(const StageSession& session) {
  const SceneRun& run = session.run();
  live::PageScene out;
  out.run = true;
  out.title = run.scene().name;
  out.rate_hz = session.frames_hz();
  for (std::size_t b = 0; b < run.size(); ++b) {
    live::PageSkeleton& body = out.skeletons.emplace_back();
    body.name = run.body(b).id;
    body.kind = live::PageSkeletonKind::kAvatar;
    body.skeleton = run.body(b).character.skeleton;
  }
  const std::vector<live::PageTarget> places = session.targets();
  for (std::size_t t = 0; t < places.size(); ++t) {
    live::PageConstraint& target = out.constraints.emplace_back();
    target.id = session.handles()[t].id;
    target.draggable = session.handles()[t].draggable;
    target.active = places[t].held;
    target.p_in_world = places[t].p_in_world;
  }
  return out;
}

/// Returns messages about the run: actions that could not begin, skipped steps.
std::vector<std::string> messages_of(const StageSession& session) {
  constexpr std::size_t kMax = 5;
  std::vector<std::string> out;
  for (const Error& problem : session.run().problems()) {
    if (out.size() == kMax) break;
    out.push_back(problem.message());
  }
  if (session.skipped() > 0) {
    out.push_back(std::to_string(session.skipped()) +
                  " steps were skipped, because this machine is too slow");
  }
  return out;
}

}  // namespace

Result<StagePage> StagePage::open(const PageServerOptions& options,
                                  const StageSession& session) {
  auto server = start_page(options);
  if (!server) return server.error();
  StagePage page(*std::move(server));
  const SceneRun& run = session.run();
  page.frame_s_ = 1.0 / session.frames_hz();
  page.figures_.resize(run.size());
  for (std::size_t b = 0; b < run.size(); ++b) {
    page.figures_[b].joints = run.body(b).character.skeleton.joints.size();
  }
  page.page_.server.publish_text(live::PageMessage::kScene,
                                 live::scene_json(page_scene(session)));
  return page;
}

void StagePage::answer(StageSession& session, Timestamp now) {
  page_.server.take_texts(texts_);
  bool has_changed = false;
  for (const live::ReceivedText& text : texts_) {
    const auto request = read_stage_request(text.text, session.handles());
    const Status done = request ? session.apply(*request, now) : Status(request.error());
    if (!done) {
      page_.server.answer_text(text.client, live::error_json(done.error().message()));
      continue;
    }
    has_changed |= !std::holds_alternative<std::monostate>(*request);
  }
  if (!has_changed) return;
  publish_targets(session);
  publish_run(session);
}

void StagePage::publish_frame(const StageSession& session, Timestamp now) {
  const std::uint32_t number = frame_++;
  if (page_.server.client_count() == 0) return;
  const SceneRun& run = session.run();
  for (std::size_t b = 0; b < figures_.size(); ++b) figures_[b].pose = &run.pose(b);
  live::PageFrame frame;
  frame.frame = number;
  frame.time_s = number * frame_s_;
  frame.sent_s = seconds(now);
  frame.figures = figures_;
  bytes_.clear();
  live::append_frame(frame, bytes_);
  page_.server.publish_frame(bytes_);
  publish_targets(session);
}

void StagePage::publish_targets(const StageSession& session) {
  if (session.handles().empty()) return;
  page_.server.publish_text(live::PageMessage::kTargets,
                            live::targets_json(session.targets()));
}

void StagePage::publish_run(StageSession& session) {
  live::PageRun run;
  run.state =
      session.is_playing() ? live::PageRunState::kPlaying : live::PageRunState::kPaused;
  run.time_s = session.run().time_s();
  run.duration_s = session.run().scene().duration_s;
  run.figures = session.report_figures();
  run.messages = messages_of(session);
  page_.server.publish_text(live::PageMessage::kRun, live::run_json(run));
}

}  // namespace marey::app
