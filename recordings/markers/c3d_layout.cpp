// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/c3d_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "recordings/base/motion_limits.h"
#include "recordings/markers/c3d_words.h"

namespace marey::recordings {
namespace {

constexpr std::size_t kMaxSectionBlock = 20;  // Blocks after the header.

std::optional<C3dSection> section_at(std::string_view bytes, std::size_t block) {
  if (block < 2 || block * kC3dBlock > bytes.size()) return std::nullopt;
  const std::size_t begin = (block - 1) * kC3dBlock;
  const int processor = static_cast<unsigned char>(bytes[begin + 3]);
  if (processor < 84 || processor > 86) return std::nullopt;
  return C3dSection{begin, static_cast<C3dProcessor>(processor)};
}

/// The header's fields, by the User Guide's word numbers.
class Header {
 public:
  Header(std::string_view bytes, C3dProcessor processor)
      : bytes_(bytes), processor_(processor) {}

  [[nodiscard]] int word(std::size_t number) const {
    return c3d_word(processor_, bytes_.data() + 2 * (number - 1));
  }
  [[nodiscard]] double real(std::size_t number) const {
    return c3d_real(processor_, bytes_.data() + 2 * (number - 1));
  }
  [[nodiscard]] std::string text(std::size_t number, std::size_t length) const {
    std::string label(bytes_.substr(2 * (number - 1), length));
    label = label.substr(0, label.find('\0'));
    while (!label.empty() && label.back() == ' ') label.pop_back();
    return label;
  }
  [[nodiscard]] bool flag(std::size_t number, std::size_t byte) const {
    return bytes_[2 * (number - 1) + byte] != 0;
  }

 private:
  std::string_view bytes_;
  C3dProcessor processor_;
};

/// Returns a count from a parameter: 16 bits unsigned, or a real.
std::optional<std::int64_t> count_in(const C3dInfo& info,
                                     const char* group,
                                     const char* name) {
  const C3dParameter* p = find_parameter(info.groups, group, name);
  if (p == nullptr) return std::nullopt;
  const std::vector<double> values = numbers(*p, true);
  if (values.empty() || !(values[0] >= 0.0 && values[0] < 1e12)) return std::nullopt;
  return static_cast<std::int64_t>(values[0]);
}

/// TRIAL:ACTUAL_..._FIELD: a number of 32 bits in two words, the low one first.
std::optional<std::int64_t> trial_field(const C3dInfo& info, const char* name) {
  const C3dParameter* p = find_parameter(info.groups, "TRIAL", name);
  if (p == nullptr) return std::nullopt;
  const std::vector<double> words = numbers(*p, true);
  if (words.size() < 2 || words[1] > 32767.0) return std::nullopt;
  const double value = words[0] + 65536.0 * words[1];
  if (!(value >= 1.0 && value < 2147483647.0)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

std::optional<double> real_in(const C3dInfo& info, const char* group, const char* name) {
  const C3dParameter* p = find_parameter(info.groups, group, name);
  if (p == nullptr) return std::nullopt;
  const std::vector<double> values = numbers(*p);
  if (values.empty() || !std::isfinite(values[0])) return std::nullopt;
  return values[0];
}

/// One candidate interpretation of the file.
struct Guess {
  std::int64_t block = 2;
  std::int64_t points = 0;
  std::int64_t analog = 0;  ///< Analog words per frame.
  std::int64_t frames = 0;
  bool real = true;

  [[nodiscard]] std::uint64_t data_at() const {
    return static_cast<std::uint64_t>(block - 1) * kC3dBlock;
  }
  [[nodiscard]] std::uint64_t frame_bytes() const {
    return static_cast<std::uint64_t>(4 * points + analog) * (real ? 4U : 2U);
  }
  [[nodiscard]] std::int64_t whole_frames(std::uint64_t file_size) const {
    if (file_size <= data_at() || frame_bytes() == 0) return 0;
    return static_cast<std::int64_t>((file_size - data_at()) / frame_bytes());
  }
  /// Returns true if the frames end in the file's last block.
  [[nodiscard]] bool fits(std::uint64_t file_size) const {
    if (frames <= 0 || frames > whole_frames(file_size)) return false;
    const std::uint64_t end =
        data_at() + static_cast<std::uint64_t>(frames) * frame_bytes();
    return file_size - end < kC3dBlock;
  }
};

/// Candidate values of each number from header and parameters, most reliable first.
struct Words {
  std::vector<std::int64_t> blocks, points, analog, frames;
  std::vector<bool> reals;
};

template <class T>
void add(std::vector<T>& list, std::optional<T> value) {
  if (value && std::find(list.begin(), list.end(), *value) == list.end()) {
    list.push_back(*value);
  }
}

Words words_of(const Header& header, const C3dInfo& info) {
  using Count = std::optional<std::int64_t>;
  Words words;
  add(words.blocks, Count(header.word(9)));
  add(words.blocks, count_in(info, "POINT", "DATA_START"));
  std::erase_if(words.blocks, [](std::int64_t block) { return block < 2; });
  if (words.blocks.empty()) words.blocks.push_back(2);
  add(words.points, Count(header.word(2)));
  add(words.points, count_in(info, "POINT", "USED"));
  add(words.analog, Count(header.word(3)));
  if (const auto channels = count_in(info, "ANALOG", "USED"); channels) {
    const auto analog_rate = real_in(info, "ANALOG", "RATE");
    const auto rate = real_in(info, "POINT", "RATE");
    add(words.analog, Count(*channels * std::max(1, header.word(10))));
    if (analog_rate && rate && *rate > 0.0 && *analog_rate > 0.0 &&
        *analog_rate / *rate < 1e4) {
      add(words.analog, Count(*channels * std::llround(*analog_rate / *rate)));
    }
  }
  std::erase_if(words.analog, [](std::int64_t n) { return n > 10'000'000; });
  const auto first = trial_field(info, "ACTUAL_START_FIELD");
  const auto last = trial_field(info, "ACTUAL_END_FIELD");
  if (first && last && *last >= *first) add(words.frames, Count(*last - *first + 1));
  add(words.frames, count_in(info, "POINT", "LONG_FRAMES"));
  if (header.word(5) >= header.word(4)) {
    add(words.frames, Count(header.word(5) - header.word(4) + 1));
  }
  add(words.frames, count_in(info, "POINT", "FRAMES"));
  std::erase_if(words.frames, [](std::int64_t n) { return n < 1 || n > 2147483647; });
  add(words.reals, std::optional<bool>(!(header.real(7) > 0.0)));
  if (const auto scale = real_in(info, "POINT", "SCALE"); scale && *scale != 0.0) {
    add(words.reals, std::optional<bool>(*scale < 0.0));
  }
  return words;
}

Guess first_words(const Words& words) {
  Guess guess;
  guess.block = words.blocks[0];
  guess.points = words.points[0];
  guess.analog = words.analog[0];
  guess.real = words.reals[0];
  return guess;
}

/// Returns the first combination of candidates whose frames end where the file ends.
std::optional<Guess> fitting(const Words& words, std::uint64_t file_size) {
  Guess guess;
  for (const bool real : words.reals) {
    guess.real = real;
    for (const std::int64_t block : words.blocks) {
      guess.block = block;
      for (const std::int64_t points : words.points) {
        guess.points = points;
        for (const std::int64_t analog : words.analog) {
          guess.analog = analog;
          for (const std::int64_t frames : words.frames) {
            guess.frames = frames;
            if (guess.fits(file_size)) return guess;
          }
        }
      }
    }
  }
  return std::nullopt;
}

std::string count_text(std::int64_t count) {
  return std::to_string(count);
}

/// Sets the frames if no combination fits: the declared ones, or the available part of
/// them.
void settle_frames(const Words& words,
                   std::uint64_t file_size,
                   Guess& guess,
                   C3dInfo& info) {
  const std::int64_t there = guess.whole_frames(file_size);
  if (guess.frame_bytes() == 0) {
    guess.frames = words.frames.empty() ? 0 : words.frames[0];
    return;
  }
  for (const std::int64_t declared : words.frames) {
    // 65535 may mean "65535 or more".
    if (declared == 65535 && there > declared) break;
    if (declared > there) continue;
    guess.frames = declared;
    return;
  }
  guess.frames = std::min<std::int64_t>(there, 2147483647);
  if (words.frames.empty()) {
    info.notes.push_back("the file does not state how many frames it has; there are " +
                         count_text(guess.frames));
  } else if (words.frames[0] > there) {
    const std::uint64_t end =
        guess.data_at() + static_cast<std::uint64_t>(guess.frames) * guess.frame_bytes();
    info.notes.push_back("the file ends early: of " + count_text(words.frames[0]) +
                         " frames " + count_text(guess.frames) +
                         " are whole, up to byte " + std::to_string(end));
  } else {
    info.notes.push_back("more frames than the 65535 that the header can count: " +
                         count_text(guess.frames));
  }
}

void note_changes(const Guess& first, const Guess& guess, C3dInfo& info) {
  const auto note_difference = [&](const char* what,
                                   std::int64_t declared,
                                   std::int64_t found) {
    if (declared == found) return;
    info.notes.push_back(std::string("the header states ") + count_text(declared) + " " +
                         what + "; by the size of the file it is " + count_text(found));
  };
  note_difference("as the frames' first block", first.block, guess.block);
  note_difference("points", first.points, guess.points);
  note_difference("analog samples in a frame", first.analog, guess.analog);
  if (first.real != guess.real) {
    info.notes.emplace_back(
        "header and POINT:SCALE contradict each other on whether frames hold integers; "
        "the size of the file decided");
  }
}

void settle_analog(const Header& header, const Guess& guess, C3dInfo& info) {
  const auto channels = count_in(info, "ANALOG", "USED").value_or(0);
  const std::int64_t per_frame = header.word(10);
  if (channels > 0 && guess.analog % channels == 0 && guess.analog > 0) {
    info.analog_channels = static_cast<int>(channels);
  } else if (per_frame > 0 && guess.analog % per_frame == 0) {
    info.analog_channels = static_cast<int>(guess.analog / per_frame);
  } else {
    info.analog_channels = static_cast<int>(guess.analog);
  }
  info.analog_per_frame = info.analog_channels == 0
                              ? 1
                              : static_cast<int>(guess.analog / info.analog_channels);
}

Status settle_rate(const Header& header, const std::string& file, C3dInfo& info) {
  const auto usable = [](std::optional<double> hz) {
    return hz && *hz >= kMinRateHz && *hz <= 10.0 * kMaxRateHz;
  };
  const double declared = header.real(11);
  const auto parameter = real_in(info, "POINT", "RATE");
  if (usable(parameter)) {
    info.rate_hz = *parameter;
    if (usable(declared) && std::abs(declared - *parameter) > 0.001 * declared) {
      info.notes.emplace_back(
          "the header's frame rate differs from POINT:RATE, which is used");
    }
    return Done{};
  }
  if (usable(declared)) {
    info.rate_hz = declared;
    return Done{};
  }
  if (info.frames <= 1) {
    info.rate_hz = 1.0;
    info.notes.emplace_back("there is no frame rate, and one frame needs none");
    return Done{};
  }
  return bad_input(file + ": byte 20",
                   "neither the header nor POINT:RATE has a frame rate between 0.1 and "
                   "20000 Hz",
                   "export the file again with its rate");
}

void read_scale(const Header& header, C3dInfo& info) {
  double scale = std::abs(header.real(7));
  if (!(scale > 0.0 && std::isfinite(scale))) {
    scale = std::abs(real_in(info, "POINT", "SCALE").value_or(0.0));
  }
  if (!(scale > 0.0 && std::isfinite(scale))) {
    scale = 1.0;
    info.notes.emplace_back("there is no POINT:SCALE; 1 is used");
  }
  info.scale = scale;
}

void read_header_events(const Header& header, C3dInfo& info) {
  // The key states that labels have four letters; two-letter labels occur only in old
  // files.
  if (header.word(150) != 12345) return;
  const int count = std::min(header.word(151), 18);
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    C3dHeaderEvent event;
    event.time_s = header.real(153 + 2 * n);
    event.shown = header.flag(189, n);
    event.label = header.text(199 + 2 * n, 4);
    if (std::isfinite(event.time_s)) info.header_events.push_back(std::move(event));
  }
}

}  // namespace

Result<C3dSection> find_c3d_section(std::string_view bytes,
                                    const std::string& file,
                                    std::vector<std::string>& notes) {
  const char* const next =
      "give a file in C3D format; the extension .c3d alone is not enough";
  if (bytes.size() < 2 * kC3dBlock) {
    return bad_input(file + ": byte " + std::to_string(bytes.size()),
                     "the file ends before its header and parameters do",
                     "copy or export it again");
  }
  if (bytes[1] != 0x50) {
    return bad_input(
        file + ": byte 1", "this is not a C3D file: it lacks the mark 80", next);
  }
  const std::size_t declared = static_cast<unsigned char>(bytes[0]);
  if (const auto section = section_at(bytes, declared)) return *section;
  for (std::size_t block = 2; block <= kMaxSectionBlock; ++block) {
    if (const auto section = section_at(bytes, block)) {
      notes.push_back("byte 0: the parameters are not in block " +
                      std::to_string(declared) + " but in block " +
                      std::to_string(block));
      return *section;
    }
  }
  return bad_input(file + ": byte 0",
                   "there is no parameter section in block " + std::to_string(declared) +
                       " or near it",
                   "export the file again");
}

Result<C3dLayout> lay_out_c3d(std::string_view bytes,
                              std::uint64_t file_size,
                              const std::string& file,
                              C3dInfo& info) {
  MAREY_ASSERT(bytes.size() >= kC3dBlock);
  const Header header(bytes, info.processor);
  const Words words = words_of(header, info);
  const Guess first = first_words(words);
  Guess guess = first;
  if (const auto found = fitting(words, file_size)) {
    guess = *found;
    note_changes(first, guess, info);
  } else {
    settle_frames(words, file_size, guess, info);
  }
  if (guess.frames == 0 && guess.frame_bytes() > 0 && !words.frames.empty()) {
    return bad_input(file + ": byte " + std::to_string(file_size),
                     "the file ends before its first frame, at byte " +
                         std::to_string(guess.data_at()) + ", does",
                     "copy or export it again");
  }
  info.numbers = guess.real ? C3dNumbers::kReal : C3dNumbers::kInteger;
  info.points = static_cast<int>(guess.points);
  info.frames = guess.frames;
  info.first_frame =
      static_cast<int>(trial_field(info, "ACTUAL_START_FIELD").value_or(header.word(4)));
  info.interpolation_gap = header.word(6);
  settle_analog(header, guess, info);
  read_scale(header, info);
  read_header_events(header, info);
  if (const Status ok = settle_rate(header, file, info); !ok) return ok.error();
  C3dLayout layout;
  layout.data_at = guess.data_at();
  layout.frame_words = static_cast<std::size_t>(4 * guess.points + guess.analog);
  layout.bytes_per_word = guess.real ? 4 : 2;
  return layout;
}

}  // namespace marey::recordings
