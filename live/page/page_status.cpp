// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_status.h"

#include "live/page/page_json.h"

namespace marey::live {
namespace {

const char* name(PageSubject subject) {
  switch (subject) {
    case PageSubject::kWaiting:
      return "waiting";
    case PageSubject::kTracked:
      return "tracked";
    case PageSubject::kPartly:
      return "partly";
    case PageSubject::kBehind:
      return "behind";
    case PageSubject::kStopped:
      return "stopped";
    case PageSubject::kLost:
      return "lost";
  }
  return "waiting";
}

const char* name(PageCameraState state) {
  switch (state) {
    case PageCameraState::kStreaming:
      return "streaming";
    case PageCameraState::kSilent:
      return "silent";
    case PageCameraState::kLost:
      return "lost";
  }
  return "silent";
}

PageJson stage_object(const PageStage& stage) {
  return {{"name", stage.name},
          {"p50_ms", stage.spread.p50_ms},
          {"p95_ms", stage.spread.p95_ms}};
}

PageJson camera_status_object(const PageCameraStatus& camera) {
  return {{"name", camera.name},
          {"state", name(camera.state)},
          {"frames", camera.frames},
          {"dropped", camera.dropped},
          {"tags", camera.tags},
          {"detail", camera.detail}};
}

PageJson output_object(const PageOutput& output) {
  return {{"name", output.name},
          {"sent", output.sent},
          {"failed", output.failed},
          {"detail", output.detail}};
}

PageJson recording_object(const std::optional<PageRecording>& recording) {
  if (!recording) return {};
  return {{"file", recording->file},
          {"seconds", recording->seconds},
          {"trouble", recording->trouble}};
}

}  // namespace

std::string status_json(const PageStatus& status) {
  return in_one_line(
      {{"type", "status"},
       {"clock_s", status.clock_s},
       {"subject", name(status.subject)},
       {"warnings", status.warnings},
       {"frame", status.frame},
       {"rate_hz", status.rate_hz},
       {"latency_ms", {{"p50", status.latency.p50_ms}, {"p95", status.latency.p95_ms}}},
       {"stages", array_of(status.stages, stage_object)},
       {"overload", status.overload},
       {"cameras", array_of(status.cameras, camera_status_object)},
       {"outputs", array_of(status.outputs, output_object)},
       {"recording", recording_object(status.recording)},
       {"clients", status.clients},
       {"messages", status.messages}});
}

std::string error_json(const std::string& text, const std::string& about) {
  if (about.empty()) return in_one_line({{"type", "error"}, {"text", text}});
  return in_one_line({{"type", "error"}, {"text", text}, {"about", about}});
}

}  // namespace marey::live
