// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/mjpg_video.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/assert.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
}

namespace marey::recordings {
namespace {

/// Matroska's own time base, which the muxer is set to.
constexpr AVRational kMilliseconds{1, 1000};

std::string text_of(int problem) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(problem, text.data(), text.size());
  return text.data();
}

}  // namespace

struct MjpgVideo::Impl {
  std::string file;
  AVFormatContext* muxer = nullptr;
  AVPacket* packet = av_packet_alloc();
  bool begun = false;
  std::int64_t last_ms = -1;

  explicit Impl(std::string name) : file(std::move(name)) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    // Without finish() the file stays incomplete.
    if (muxer != nullptr) avio_closep(&muxer->pb);
    avformat_free_context(muxer);
    av_packet_free(&packet);
  }

  [[nodiscard]] Error error(const std::string& what, int problem) const {
    return {Errc::kDevice,
            file,
            what + ": " + text_of(problem),
            "free some disk space, or record to another disk"};
  }

  [[nodiscard]] int begin(const MjpgVideoOptions& options);
};

int MjpgVideo::Impl::begin(const MjpgVideoOptions& options) {
  // The library must not print; errors are returned to the caller.
  av_log_set_level(AV_LOG_QUIET);
  int problem = avformat_alloc_output_context2(&muxer, nullptr, "matroska", file.c_str());
  if (problem < 0) return problem;
  AVStream* stream = avformat_new_stream(muxer, nullptr);
  if (stream == nullptr || packet == nullptr) return AVERROR(ENOMEM);
  stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
  stream->codecpar->codec_id = AV_CODEC_ID_MJPEG;
  stream->codecpar->width = options.width_px;
  stream->codecpar->height = options.height_px;
  stream->time_base = kMilliseconds;
  stream->avg_frame_rate = av_d2q(options.rate.hz, 1000000);
  // Without the protocol's name, "a:b.mkv" would have the protocol "a".
  problem = avio_open(&muxer->pb, ("file:" + file).c_str(), AVIO_FLAG_WRITE);
  if (problem < 0) return problem;
  muxer->flags |= AVFMT_FLAG_FLUSH_PACKETS;
  AVDictionary* settings = nullptr;
  // A cluster is collected in memory and written as a whole.
  av_dict_set_int(&settings, "cluster_time_limit", options.flush_every.count(), 0);
  av_dict_set_int(&settings, "cluster_size_limit", 4 << 20, 0);
  problem = avformat_write_header(muxer, &settings);
  av_dict_free(&settings);
  if (problem < 0) return problem;
  avio_flush(muxer->pb);
  begun = true;
  return muxer->pb->error;
}

MjpgVideo::MjpgVideo(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MjpgVideo::MjpgVideo(MjpgVideo&&) noexcept = default;
MjpgVideo& MjpgVideo::operator=(MjpgVideo&&) noexcept = default;
MjpgVideo::~MjpgVideo() = default;

Result<MjpgVideo> MjpgVideo::create(const std::filesystem::path& path,
                                    const MjpgVideoOptions& options) {
  MAREY_ASSERT(options.width_px > 0 && options.height_px > 0 && options.rate.hz > 0.0);
  auto impl = std::make_unique<Impl>(path.string());
  if (const int problem = impl->begin(options); problem < 0) {
    const bool made = impl->muxer != nullptr && impl->muxer->pb != nullptr;
    std::error_code ignored;
    if (made) std::filesystem::remove(path, ignored);
    return impl->error("the video cannot be started", problem);
  }
  return MjpgVideo(std::move(impl));
}

Status MjpgVideo::write(std::span<const std::byte> jpeg, Timestamp time) {
  MAREY_ASSERT(impl_->begun);
  using std::chrono::milliseconds;
  AVPacket& packet = *impl_->packet;
  const std::int64_t now_ms = std::chrono::round<milliseconds>(time).count();
  impl_->last_ms = std::max(impl_->last_ms + 1, now_ms);
  // Borrowed: the muxer copies data that are not reference-counted.
  packet.data = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(jpeg.data()));
  packet.size = static_cast<int>(jpeg.size());
  packet.pts = packet.dts = impl_->last_ms;
  packet.duration = 0;
  packet.stream_index = 0;
  packet.flags = AV_PKT_FLAG_KEY;
  packet.time_base = kMilliseconds;
  const int problem = av_write_frame(impl_->muxer, &packet);
  packet.data = nullptr;
  packet.size = 0;
  if (problem < 0) return impl_->error("a frame cannot be written", problem);
  if (const int late = impl_->muxer->pb->error; late < 0) {
    return impl_->error("a frame cannot be written", late);
  }
  return Done{};
}

Status MjpgVideo::flush() {
  MAREY_ASSERT(impl_->begun);
  int problem = av_write_frame(impl_->muxer, nullptr);
  avio_flush(impl_->muxer->pb);
  if (problem >= 0) problem = impl_->muxer->pb->error;
  if (problem < 0) return impl_->error("frames cannot be written", problem);
  return Done{};
}

Status MjpgVideo::finish() {
  MAREY_ASSERT(impl_->begun);
  impl_->begun = false;
  int problem = av_write_trailer(impl_->muxer);
  if (problem >= 0) problem = impl_->muxer->pb->error;
  const int closed = avio_closep(&impl_->muxer->pb);
  if (problem >= 0) problem = closed;
  if (problem < 0) return impl_->error("the video cannot be completed", problem);
  return Done{};
}

}  // namespace marey::recordings
