// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_page.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "app/live_chain/body_handles.h"
#include "app/live_chain/live_health.h"
#include "app/view/view_figure.h"
#include "app/view/view_page.h"
#include "live/page/page_request.h"

namespace marey::app {
namespace {

using reconstruct::TrackState;

double now_s() {
  return seconds(std::chrono::steady_clock::now().time_since_epoch());
}

live::PageSpread spread_of(const LatencyHistogram& times) {
  return {1000.0 * times.quantile_s(0.5), 1000.0 * times.quantile_s(0.95)};
}

std::vector<live::PageStage> stages_of(const LiveTimes& times,
                                       const std::vector<LiveCameraFigures>& cameras) {
  std::vector<live::PageStage> stages;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    stages.push_back({"decode " + cameras[c].name, spread_of(times.decode[c])});
    stages.push_back({"detect " + cameras[c].name, spread_of(times.detect[c])});
  }
  stages.push_back({"wait", spread_of(times.wait)});
  stages.push_back({"solve", spread_of(times.solve)});
  stages.push_back({"retarget", spread_of(times.retarget)});
  stages.push_back({"encode", spread_of(times.encode)});
  stages.push_back({"send", spread_of(times.send)});
  return stages;
}

/// Returns a description of the current overload, from the recently skipped pictures.
std::string overload_of(const std::vector<LiveCameraFigures>& cameras,
                        const std::vector<LiveCameraFigures>& before) {
  long stale = 0;
  long unused = 0;
  for (std::size_t c = 0; c < cameras.size() && c < before.size(); ++c) {
    stale += cameras[c].stale - before[c].stale;
    unused += cameras[c].unused - before[c].unused;
  }
  if (stale > 0) return "pictures that are too old are skipped";
  if (unused > 0) return "pictures come too late for their instant";
  return "none";
}

}  // namespace

Result<std::unique_ptr<LivePage>> LivePage::open(const PageServerOptions& options,
                                                 const OpenedLive& live,
                                                 const Skeleton& performer,
                                                 LiveWizard* wizard) {
  auto page = start_page(options);
  if (!page) return page.error();
  auto out = std::unique_ptr<LivePage>(new LivePage(*std::move(page)));
  out->wizard_ = wizard;
  out->has_body_ = live.body.has_value();
  if (const Status ok = out->make_scene(live, performer); !ok) return ok.error();
  return out;
}

Status LivePage::make_scene(const OpenedLive& live, const Skeleton& performer) {
  constexpr double kSpacing_m = 1.2;
  if (live.body) watch(*live.body);
  scene_.title = live.session;
  scene_.rate_hz = live.settings.rate.hz;
  for (std::size_t c = 0; c < live.calibration.cameras.size(); ++c) {
    scene_.cameras.push_back(
        {live.calibration.cameras[c], live.calibration.quality[c].rms_px});
  }
  live::PageSkeleton body;
  const std::string& name = live.body ? live.body->name : live.prior.name;
  body.name = name.empty() ? "performer" : name;
  body.kind = live::PageSkeletonKind::kPerformer;
  body.skeleton = performer;
  body.estimate = true;
  scene_.skeletons.push_back(std::move(body));
  for (std::size_t a = 0; a < live.avatars.size(); ++a) {
    std::vector<std::string> remarks;  // Reported when it was opened.
    auto figure = figure_of_file(live.avatars[a].file, remarks);
    if (!figure) return figure.error();
    figure->kind = live::PageSkeletonKind::kAvatar;
    const std::string path = "/media/" + std::to_string(a + 1);
    if (figure->skin) {
      auto skin = file_content(figure->skin->file, path, "model/gltf-binary");
      if (!skin) return skin.error();
      page_.server.put(*std::move(skin));
    }
    const glm::dvec3 offset_m(kSpacing_m * static_cast<double>(a + 1), 0.0, 0.0);
    scene_.skeletons.push_back(page_skeleton(*figure, path, offset_m));
  }
  if (!live.avatars.empty()) {
    for (const BodyHandle& handle : body_handles(live.avatars.front().skeleton)) {
      live::PageConstraint& shown = scene_.constraints.emplace_back();
      shown.id = handle.id;
      shown.skeleton = 1;  // The first behind the performer.
      shown.active = false;
      shown.draggable = true;
      shown.joint = handle.joint;
    }
  }
  figures_.resize(scene_.skeletons.size());
  for (std::size_t s = 0; s < figures_.size(); ++s) {
    figures_[s].joints = scene_.skeletons[s].skeleton.joints.size();
  }
  make_balance();
  encoders_.resize(scene_.cameras.size());
  tags_seen_.assign(scene_.cameras.size(), 0);
  if (wizard_) scene_.wizard = wizard_->ui_state();
  page_.server.publish_text(live::PageMessage::kScene, live::scene_json(scene_));
  return Done{};
}

/// Reports the segments and the warnings of this body from now on.
void LivePage::watch(const Body& body) {
  worn_ = WornSegments(body);
  body_warnings_.clear();
  for (const Finding& warning : body.warnings) {
    body_warnings_.push_back("the measured body may be wrong: " + warning.cause +
                             ". Next: " + warning.next);
  }
}

void LivePage::on_body(const Body& body, const Skeleton& performer) {
  watch(body);
  live::PageSkeleton& shown = scene_.skeletons.front();
  if (!body.name.empty()) shown.name = body.name;
  shown.skeleton = performer;
  figures_.front().joints = performer.joints.size();
  make_balance();
  has_body_ = true;
  if (wizard_) scene_.wizard = wizard_->ui_state();
  ++scene_.revision;
  page_.server.publish_text(live::PageMessage::kScene, live::scene_json(scene_));
  show_wizard();
}

void LivePage::show_wizard() {
  if (!wizard_) return;
  shown_step_ = wizard_->ui_state().step;
  page_.server.publish_text(live::PageMessage::kWizard,
                            live::wizard_json(wizard_->ui_state()));
}

LivePage::Answer LivePage::answer(const std::string& text,
                                  live::ClientId from,
                                  LiveRequests& requests) {
  const auto request = live::read_page_request(text);
  if (!request) return {request.error().message()};
  if (const auto* thumbnails = std::get_if<live::ThumbnailsRequest>(&*request)) {
    thumbnails_.ask(from, thumbnails->on);
    return {};
  }
  if (const auto* drag = std::get_if<live::DragRequest>(&*request)) {
    return {ask({drag->id, HandleAction::kMove, drag->p_in_world}, requests)};
  }
  if (const auto* hold = std::get_if<live::ConstraintRequest>(&*request)) {
    const HandleAction action = hold->active ? HandleAction::kStart : HandleAction::kStop;
    return {ask({hold->id, action, {}}, requests)};
  }
  if (const auto* record = std::get_if<live::RecordRequest>(&*request)) {
    if (record->on && !has_body_) {
      return {"no subject is measured yet: measure one before recording"};
    }
    record_request_ = record->on;
    return {};
  }
  if (const auto* wizard = std::get_if<live::WizardRequest>(&*request)) {
    if (!wizard_) return {"the session does not name a subject to be measured", "wizard"};
    const auto refusal = wizard_->act(wizard->action);
    show_wizard();
    return {refusal.value_or(""), "wizard"};
  }
  const bool is_understood = std::holds_alternative<live::HelloRequest>(*request) ||
                             std::holds_alternative<live::ShownRequest>(*request);
  return {is_understood ? "" : "this run does not support that request"};
}

/// Adds a request for a handle. Returns the reason if it is rejected, else an empty text.
std::string LivePage::ask(HandleRequest request, LiveRequests& requests) {
  const bool is_known =
      std::ranges::find(scene_.constraints, request.id, &live::PageConstraint::id) !=
      scene_.constraints.end();
  if (!is_known) return "there is no handle \"" + request.id + "\"";
  const bool is_taken = requests.add(std::move(request));
  return is_taken ? std::string() : "too many requests at once";
}

/// Publishes the targets of active handles, up to kMaxPerSecond times a second while they
/// change. Inactive handles follow their joints, whose pose the page has.
void LivePage::publish_handles(std::span<const HandleState> handles) {
  constexpr double kMaxPerSecond = 10.0;
  const double frames_since = frame_ - handles_published_;
  if (frames_since * kMaxPerSecond < scene_.rate_hz) return;
  bool changed = false;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    live::PageConstraint& sent = scene_.constraints[i];
    const HandleState& now = handles[i];
    if (sent.active == now.active && (!now.active || sent.p_in_world == now.p_in_world)) {
      continue;
    }
    changed = true;
    sent.active = now.active;
    sent.p_in_world = now.p_in_world;
    sent.joint = now.active ? std::nullopt : std::optional(now.joint);
  }
  if (!changed) return;
  handles_published_ = frame_;
  page_.server.publish_text(live::PageMessage::kConstraints,
                            live::constraints_json(scene_.constraints));
}

void LivePage::take_requests(LiveRequests& requests) {
  page_.server.take_texts(texts_);
  for (const live::ReceivedText& text : texts_) {
    const Answer said = answer(text.text, text.client, requests);
    if (!said.text.empty()) {
      page_.server.answer_text(text.client, live::error_json(said.text, said.about));
    }
  }
}

void LivePage::on_frame(const LiveInstant& instant, const LiveResult& result) {
  if (!first_) first_ = instant.time;
  std::fill(tags_seen_.begin(), tags_seen_.end(), 0);
  for (const CameraTags& view : instant.views) {
    tags_seen_[index(view.camera)] = static_cast<int>(view.tags.size());
  }
  if (wizard_ && wizard_->ui_state().step != shown_step_) show_wizard();
  update_balance(instant, result);
  uncertainty_.assign(result.uncertainty.begin(), result.uncertainty.end());
  if (page_.server.client_count() == 0) {
    thumbnails_.reset();
    ++frame_;
    return;
  }
  pose_bodies(result);
  live::PageFrame frame;
  frame.frame = frame_++;
  frame.time_s = seconds(instant.time - *first_);
  frame.sent_s = now_s();
  frame.figures = figures_;
  bytes_.clear();
  live::append_frame(frame, bytes_);
  page_.server.publish_frame(bytes_);
  publish_handles(result.handles);
}

void LivePage::on_thumbnail(std::size_t camera,
                            std::span<const std::byte> pixels,
                            int width_px,
                            int height_px,
                            std::span<const TagDetection> tags) {
  auto& encoder = encoders_[camera];
  if (!encoder) {
    auto made = recordings::JpegEncoder::create(
        recordings::RawLayout::kGrey, width_px, height_px, width_px);
    if (!made) return;
    encoder.emplace(*std::move(made));
  }
  const auto jpeg = encoder->encode(pixels);
  live::PageThumbnail thumbnail;
  thumbnail.camera = static_cast<std::uint8_t>(camera);
  thumbnail.width_px = scene_.cameras[camera].camera.intrinsics.width_px;
  thumbnail.height_px = scene_.cameras[camera].camera.intrinsics.height_px;
  thumbnail.tags = tags;
  thumbnail.jpeg = {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()};
  bytes_.clear();
  live::append_thumbnail(thumbnail, bytes_);
  page_.server.publish_thumbnail(camera, bytes_);
}

/// Adds notes to the user about changes of the state, newest last.
void LivePage::note(TrackState state, const LiveStatistics& figures) {
  constexpr std::size_t kMax = 8;
  if (state_ != state) {
    if (state == TrackState::kTracked) notes_.emplace_back("the body is found");
    if (state == TrackState::kLost) notes_.emplace_back("the body is lost");
    if (state == TrackState::kWaiting) notes_.emplace_back("waiting for the body");
    state_ = state;
  }
  if (figures.recording_trouble) {
    const std::string text = figures.recording_trouble->message();
    if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) {
      notes_.push_back(text);
    }
  }
  if (notes_.size() > kMax) notes_.erase(notes_.begin());
}

void LivePage::on_status(const LiveStatistics& figures,
                         const LiveTimes& recent,
                         TrackState state) {
  note(state, figures);
  show_wizard();
  live::PageStatus status;
  status.clock_s = since_start_.seconds();
  status.frame = static_cast<int>(frame_);
  const double lasted_s = status.clock_s - seconds_before_;
  if (lasted_s > 0.0) {
    status.rate_hz = static_cast<double>(figures.frames - frames_before_) / lasted_s;
  }
  status.latency = spread_of(recent.frame_to_packet);
  status.stages = stages_of(recent, figures.cameras);
  status.overload = overload_of(figures.cameras, cameras_before_);
  for (std::size_t c = 0; c < figures.cameras.size(); ++c) {
    const bool is_new = c >= cameras_before_.size();
    status.cameras.push_back(camera_status(
        figures.cameras[c], is_new ? nullptr : &cameras_before_[c], tags_seen_[c]));
  }
  for (std::size_t o = 0; o < figures.outputs.size(); ++o) {
    const bool is_new = o >= outputs_before_.size();
    status.outputs.push_back(
        output_status(figures.outputs[o], is_new ? nullptr : &outputs_before_[o]));
  }
  if (const auto& now = figures.recording) {
    status.recording = live::PageRecording{now->folder, now->seconds, now->trouble};
  }
  add_subject_status(state,
                     figures,
                     state == TrackState::kTracked ? worn_.unseen(uncertainty_)
                                                   : std::vector<std::string>{},
                     status);
  // Warnings about the measured body do not change the state: a badly measured body can
  // still be tracked well.
  status.warnings.insert(
      status.warnings.end(), body_warnings_.begin(), body_warnings_.end());
  if (figures.flow != Flow::kSteady) status.overload = figures.flow_text;
  status.clients = page_.server.client_count();
  status.messages = notes_;
  if (figures.has_unmatched_tags)
    status.messages.emplace_back(UnmatchedTagsDetector::kText);
  if (!figures.flow_text.empty()) status.messages.push_back(figures.flow_text);
  page_.server.publish_text(live::PageMessage::kStatus, live::status_json(status));
  cameras_before_ = figures.cameras;
  outputs_before_ = figures.outputs;
  frames_before_ = figures.frames;
  seconds_before_ = status.clock_s;
}

}  // namespace marey::app
