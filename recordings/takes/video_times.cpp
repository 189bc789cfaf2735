// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/video_times.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libavutil/mathematics.h>
}

#include "core/base/input_file.h"

namespace marey::recordings {
namespace {

constexpr AVRational kNanoseconds{1, 1000000000};
/// 70 years: longer than any video, and differences of such times do not overflow.
constexpr std::int64_t kMaxTime_ns = std::int64_t{1} << 61;

struct CloseInput {
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

std::unique_ptr<AVFormatContext, CloseInput> open_input(
    const std::filesystem::path& path) {
  if (!check_input_file(path)) return nullptr;
  // The library must not print; errors are returned to the caller.
  av_log_set_level(AV_LOG_QUIET);
  AVFormatContext* raw = nullptr;
  // Without the protocol's name, "a:b.mkv" would have the protocol "a".
  const std::string url = "file:" + path.string();
  if (avformat_open_input(&raw, url.c_str(), nullptr, nullptr) < 0) return nullptr;
  std::unique_ptr<AVFormatContext, CloseInput> input(raw);
  if (avformat_find_stream_info(raw, nullptr) < 0) return nullptr;
  return input;
}

}  // namespace

std::optional<std::vector<Timestamp>> video_times(const std::filesystem::path& path) {
  const auto input = open_input(path);
  const std::unique_ptr<AVPacket, FreePacket> packet(av_packet_alloc());
  if (!input || !packet) return std::nullopt;
  const int stream =
      av_find_best_stream(input.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream < 0) return std::nullopt;
  const AVRational base = input->streams[stream]->time_base;
  std::vector<Timestamp> times;
  while (av_read_frame(input.get(), packet.get()) >= 0) {
    const bool counts =
        packet->stream_index == stream && (packet->flags & AV_PKT_FLAG_DISCARD) == 0;
    const std::int64_t pts = packet->pts;
    av_packet_unref(packet.get());
    if (!counts) continue;
    if (pts == AV_NOPTS_VALUE) return std::nullopt;
    const std::int64_t time_ns = av_rescale_q(pts, base, kNanoseconds);
    if (time_ns < -kMaxTime_ns || time_ns > kMaxTime_ns) return std::nullopt;
    times.push_back(Timestamp{time_ns});
  }
  std::sort(times.begin(), times.end());
  if (times.empty()) return std::nullopt;
  return times;
}

}  // namespace marey::recordings
