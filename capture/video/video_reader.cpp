// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/video_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/log.h>
#include <libswscale/swscale.h>
}

#include "core/base/assert.h"
#include "core/base/input_file.h"

namespace marey::capture {
namespace {

struct CloseInput {
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
};
struct FreeDecoder {
  void operator()(AVCodecContext* decoder) const { avcodec_free_context(&decoder); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreeConverter {
  void operator()(SwsContext* converter) const { sws_freeContext(converter); }
};

Error cannot_open(const std::string& name) {
  return bad_input(name,
                   "it cannot be opened as a video: it is not one, or its index is "
                   "missing because the copy or the recording was cut short",
                   "play it in a video player; if that fails too, copy it from the "
                   "camera again");
}

double value_of(AVRational ratio) {
  return ratio.num == 0 || ratio.den == 0 ? 0.0 : av_q2d(ratio);
}

/// Returns the angle of the rotation mark, which libav counts counterclockwise. Pictures
/// are rotated clockwise by it, so that results equal those with OpenCV 4.6.
int turned_deg(const AVStream& stream) {
  const std::uint8_t* matrix =
      av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
  if (matrix == nullptr) return 0;
  const double angle_deg =
      av_display_rotation_get(reinterpret_cast<const std::int32_t*>(matrix));
  if (!std::isfinite(angle_deg)) return 0;
  return (static_cast<int>(std::lround(angle_deg)) + 360) % 360;
}

VideoFacts facts_of(const AVFormatContext& input, const AVStream& stream) {
  VideoFacts facts;
  facts.width_px = stream.codecpar->width;
  facts.height_px = stream.codecpar->height;
  facts.rate_hz = value_of(stream.avg_frame_rate);
  if (facts.rate_hz <= 0.0 && stream.time_base.num > 0) {
    facts.rate_hz = 1.0 / value_of(stream.time_base);
  }
  if (input.duration > 0) {
    facts.duration_s = static_cast<double>(input.duration) / AV_TIME_BASE;
  } else if (stream.duration > 0) {
    facts.duration_s = static_cast<double>(stream.duration) * value_of(stream.time_base);
  }
  facts.frames = stream.nb_frames > 0
                     ? static_cast<double>(stream.nb_frames)
                     : std::floor(facts.duration_s * facts.rate_hz + 0.5);
  facts.turned_deg = turned_deg(stream);
  return facts;
}

}  // namespace

struct VideoReader::Impl {
  std::unique_ptr<AVFormatContext, CloseInput> input;
  AVStream* stream = nullptr;  ///< Video stream of the input.
  VideoFacts facts;
  std::unique_ptr<AVPacket, FreePacket> packet{av_packet_alloc()};
  // For pictures.
  std::unique_ptr<AVCodecContext, FreeDecoder> decoder;
  std::unique_ptr<AVFrame, FreeFrame> frame{av_frame_alloc()};
  std::unique_ptr<AVFrame, FreeFrame> bgr;
  std::unique_ptr<SwsContext, FreeConverter> converter;
  std::int64_t grabbed = 0;

  [[nodiscard]] bool open(const std::filesystem::path& path);
  [[nodiscard]] bool open_decoder();
  /// Reads the next packet of the stream; an empty one at the end.
  void read_packet();
  [[nodiscard]] bool decode();
  [[nodiscard]] bool prepare_bgr();
};

bool VideoReader::Impl::open(const std::filesystem::path& path) {
  av_log_set_level(AV_LOG_QUIET);
  MAREY_ASSERT(packet != nullptr && frame != nullptr);
  // FFmpeg interprets names as URLs: "a:b.mkv" would have the protocol "a".
  const std::string url = "file:" + path.string();
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, url.c_str(), nullptr, nullptr) < 0) return false;
  input.reset(opened);
  if (avformat_find_stream_info(opened, nullptr) < 0) return false;
  for (unsigned i = 0; i < input->nb_streams && stream == nullptr; ++i) {
    if (input->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) {
      stream = input->streams[i];
    }
  }
  if (stream == nullptr) return false;
  facts = facts_of(*input, *stream);
  return true;
}

bool VideoReader::Impl::open_decoder() {
  const AVCodec* codec = avcodec_find_decoder(stream->codecpar->codec_id);
  if (codec == nullptr) return false;
  decoder.reset(avcodec_alloc_context3(codec));
  if (!decoder) return false;
  constexpr int kMaxThreads = 16;  // libav's own limit for a good result.
  decoder->thread_count = std::clamp(cv::getNumberOfCPUs(), 1, kMaxThreads);
  if (avcodec_parameters_to_context(decoder.get(), stream->codecpar) < 0) return false;
  if (avcodec_open2(decoder.get(), codec, nullptr) < 0) return false;
  if (facts.width_px <= 0) facts.width_px = decoder->width;
  if (facts.height_px <= 0) facts.height_px = decoder->height;
  return true;
}

void VideoReader::Impl::read_packet() {
  for (;;) {
    av_packet_unref(packet.get());
    const int read = av_read_frame(input.get(), packet.get());
    if (read == AVERROR(EAGAIN)) continue;
    if (read < 0) {
      av_packet_unref(packet.get());
      return;
    }
    if (packet->stream_index == stream->index && packet->size > 0) return;
  }
}

bool VideoReader::Impl::decode() {
  // Damaged packets without a picture in a row after which a video is given up.
  constexpr int kMaxFailures = 64;
  if (avcodec_receive_frame(decoder.get(), frame.get()) >= 0) return true;
  for (int failures = 0; failures <= kMaxFailures;) {
    read_packet();
    // An empty packet makes the decoder return the pictures that it holds back.
    if (avcodec_send_packet(decoder.get(), packet.get()) < 0) return false;
    const int received = avcodec_receive_frame(decoder.get(), frame.get());
    if (received >= 0) return true;
    if (received != AVERROR(EAGAIN)) ++failures;
  }
  return false;
}

/// Prepares the conversion to BGR. Pictures are converted with the decoder's margin: with
/// another width, libswscale rounds some pixels differently.
bool VideoReader::Impl::prepare_bgr() {
  if (!bgr) {
    bgr.reset(av_frame_alloc());
    MAREY_ASSERT(bgr != nullptr);
    bgr->format = AV_PIX_FMT_BGR24;
    bgr->width = std::max(decoder->coded_width, frame->width);
    bgr->height = std::max(decoder->coded_height, frame->height);
    constexpr int kAlign = 32;
    if (av_frame_get_buffer(bgr.get(), kAlign) < 0) return false;
  }
  converter.reset(sws_getCachedContext(converter.release(),
                                       bgr->width,
                                       bgr->height,
                                       static_cast<AVPixelFormat>(frame->format),
                                       bgr->width,
                                       bgr->height,
                                       AV_PIX_FMT_BGR24,
                                       SWS_BICUBIC,
                                       nullptr,
                                       nullptr,
                                       nullptr));
  return converter != nullptr;
}

VideoReader::VideoReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;
VideoReader::~VideoReader() = default;

std::optional<VideoReader> VideoReader::open_packets(const std::filesystem::path& path) {
  auto impl = std::make_unique<Impl>();
  if (!check_input_file(path) || !impl->open(path)) return std::nullopt;
  return VideoReader(std::move(impl));
}

Result<VideoReader> VideoReader::open_pictures(const std::filesystem::path& path,
                                               const std::string& name) {
  if (const Status ok = check_input_file(path, name); !ok) return ok.error();
  auto impl = std::make_unique<Impl>();
  if (!impl->open(path) || !impl->open_decoder()) return cannot_open(name);
  return VideoReader(std::move(impl));
}

const VideoFacts& VideoReader::facts() const {
  return impl_->facts;
}

std::optional<std::span<const std::byte>> VideoReader::next_packet() {
  impl_->read_packet();
  const AVPacket& packet = *impl_->packet;
  if (packet.data == nullptr) return std::nullopt;
  return std::as_bytes(std::span(packet.data, static_cast<std::size_t>(packet.size)));
}

bool VideoReader::grab() {
  Impl& impl = *impl_;
  MAREY_ASSERT(impl.decoder != nullptr);
  // The video has no more frames than the container states.
  if (impl.stream->nb_frames > 0 && impl.grabbed > impl.stream->nb_frames) return false;
  if (!impl.decode()) return false;
  ++impl.grabbed;
  return true;
}

cv::Size VideoReader::grabbed_size() const {
  return {impl_->frame->width, impl_->frame->height};
}

cv::Mat VideoReader::picture() {
  Impl& impl = *impl_;
  if (impl.frame->data[0] == nullptr || !impl.prepare_bgr()) return {};
  sws_scale(impl.converter.get(),
            impl.frame->data,
            impl.frame->linesize,
            0,
            impl.bgr->height,
            impl.bgr->data,
            impl.bgr->linesize);
  return cv::Mat(impl.facts.height_px,
                 impl.facts.width_px,
                 CV_8UC3,
                 impl.bgr->data[0],
                 static_cast<std::size_t>(impl.bgr->linesize[0]));
}

void turn(const cv::Mat& picture, int turned_deg, cv::Mat& turned) {
  if (turned_deg == 90) {
    cv::rotate(picture, turned, cv::ROTATE_90_CLOCKWISE);
  } else if (turned_deg == 180) {
    cv::rotate(picture, turned, cv::ROTATE_180);
  } else if (turned_deg == 270) {
    cv::rotate(picture, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
  } else {
    turned = picture;
  }
}

}  // namespace marey::capture
