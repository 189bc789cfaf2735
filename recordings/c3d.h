// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/result.h"
#include "recordings/atomic_file.h"

namespace marey::recordings {

// A C3D file as it is: header, parameters and frames, in the file's own unit and axes.
// Markers in the world are marker_file.h's, forces force_plates.h's. After the C3D User
// Guide (Motion Lab Systems), with the liberties that vendors take.

/// How numbers are stored, after the machine that they were made for. The values are the
/// file's own.
enum class C3dProcessor : std::uint8_t {
  kIntel = 84,  ///< Little-endian, IEEE.
  kDec = 85,    ///< Little-endian integers, VAX F reals.
  kMips = 86,   ///< Big-endian, IEEE. Also SGI's.
};

/// Whether frames hold reals, or 16-bit integers that a scale makes lengths.
enum class C3dNumbers : std::uint8_t { kReal, kInteger };

struct C3dText {
  std::string characters;  ///< All of them, one after the other, blanks included.
};
using C3dBytes = std::vector<std::int8_t>;
using C3dIntegers = std::vector<std::int16_t>;
using C3dReals = std::vector<float>;

/// A named array. The first dimension varies fastest; of texts it is their length.
/// Without dimensions it is one value.
struct C3dParameter {
  std::string name;
  std::string description;
  bool locked = false;
  std::vector<std::uint8_t> dimensions;
  std::variant<C3dText, C3dBytes, C3dIntegers, C3dReals> values;
};

struct C3dGroup {
  std::string name;
  std::string description;
  bool locked = false;
  std::uint8_t id = 1;  ///< 1 to 127.
  std::vector<C3dParameter> parameters;
};

/// One of the up to 18 events that the header has room for.
struct C3dHeaderEvent {
  std::string label;    ///< Up to four letters.
  double time_s = 0.0;  ///< Since frame 1.
  bool shown = true;
};

/// What a C3D says before its frames, and how marey understood it.
struct C3dInfo {
  C3dProcessor processor = C3dProcessor::kIntel;
  C3dNumbers numbers = C3dNumbers::kReal;
  int points = 0;
  int analog_channels = 0;
  int analog_per_frame = 1;  ///< Samples of each channel in one frame.
  double rate_hz = 100.0;    ///< Of frames.
  /// Length of an integer's step, and of a residual's, in the file's unit. Above 0.
  double scale = 0.1;
  int first_frame = 1;
  std::int64_t frames = 0;  ///< That are whole in the file.
  int interpolation_gap = 0;
  std::vector<C3dGroup> groups;
  std::vector<C3dHeaderEvent> header_events;
  /// What the file says wrongly, and what was made of it. Sentences without a full stop.
  std::vector<std::string> notes;
};

/// One frame, in the file's words: reals, or integers that are not yet scaled.
struct C3dFrame {
  /// x, y, z and the word of residual and cameras, of every point.
  std::vector<float> points;
  /// All channels' first samples, then their second ones. Of unsigned 16-bit integers too
  /// they are 0 to 65535.
  std::vector<float> analog;
};

/// The parameter, whatever the case of the names; null when there is none. The pointer is
/// good until `groups` changes.
[[nodiscard]] const C3dParameter* find_parameter(const std::vector<C3dGroup>& groups,
                                                 std::string_view group,
                                                 std::string_view name);

/// The texts of a parameter, without the blanks after them; none if it holds numbers.
[[nodiscard]] std::vector<std::string> texts(const C3dParameter& parameter);

/// Its numbers; none if it holds texts. With `is_unsigned`, integers are 0 to 65535.
[[nodiscard]] std::vector<double> numbers(const C3dParameter& parameter,
                                          bool is_unsigned = false);

/// texts() of GROUP:NAME and of NAME2, NAME3... after it, which hold what is beyond the
/// 255 that one parameter has room for. `numbers_of_all` likewise. Empty when there is
/// none.
[[nodiscard]] std::vector<std::string> texts_of_all(const std::vector<C3dGroup>& groups,
                                                    std::string_view group,
                                                    std::string_view name);
[[nodiscard]] std::vector<double> numbers_of_all(const std::vector<C3dGroup>& groups,
                                                 std::string_view group,
                                                 std::string_view name,
                                                 bool is_unsigned = false);

/// Adds the parameter to the group, which is made when there is none, in the place of one
/// of that name, whose description it keeps when it brings none.
void put_parameter(std::vector<C3dGroup>& groups,
                   std::string_view group,
                   C3dParameter parameter);

/// put_parameter() of a list of texts, in pieces of 255 as texts_of_all() reads them.
void put_texts(std::vector<C3dGroup>& groups,
               std::string_view group,
               std::string_view name,
               const std::vector<std::string>& list);

/// Reads a file frame by frame, in memory that does not grow with its length.
///
/// What vendors write differently is put right and said in info().notes: a parameter
/// section that is not where the header says, records that are damaged, numbers of
/// points, samples or frames that contradict each other (what fits the file's size is
/// believed), and files that end early, of which the whole frames are read.
class C3dReader {
 public:
  /// Errors (kBadInput), with the byte: not a C3D file, no parameter section, no frame
  /// rate. Else as read_file()'s.
  [[nodiscard]] static Result<C3dReader> open(const std::filesystem::path& path);
  /// The same of a file in memory; `name` is what messages call it.
  [[nodiscard]] static Result<C3dReader> of_bytes(std::string bytes, std::string name);

  C3dReader(C3dReader&&) noexcept;
  C3dReader& operator=(C3dReader&&) noexcept;
  ~C3dReader();

  [[nodiscard]] const C3dInfo& info() const;
  /// Reads the next frame into `frame`; false after the last one. Errors: the disk
  /// failed, or the file became shorter (kDevice).
  [[nodiscard]] Result<bool> next(C3dFrame& frame);

 private:
  struct State;
  explicit C3dReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a file frame by frame. Of `info`, the parameters that say what is in the header
/// (POINT:USED, FRAMES, SCALE, RATE, DATA_START; ANALOG:USED, RATE; TRIAL:ACTUAL_...) are
/// set; all others are written as they are. More than 65535 frames are counted in
/// TRIAL:ACTUAL_END_FIELD and POINT:LONG_FRAMES.
class C3dWriter {
 public:
  /// Errors (kBadInput): more points, samples or parameters than the format has room for,
  /// or AtomicFile::create()'s.
  /// Precondition: numbers of `info` not negative, rate and scale above 0.
  [[nodiscard]] static Result<C3dWriter> create(const std::filesystem::path& path,
                                                const C3dInfo& info);

  /// Precondition: as many words as `info` promised, no more frames than it did. Integers
  /// are rounded and kept within 16 bits; reals that a VAX does not have are its largest.
  void append(const C3dFrame& frame);
  /// Precondition: as many frames as `info` promised. Errors as AtomicFile::commit()'s.
  [[nodiscard]] Status commit();

 private:
  C3dWriter(AtomicFile file, const C3dInfo& info);
  AtomicFile file_;
  C3dProcessor processor_;
  C3dNumbers numbers_;
  std::size_t words_per_frame_;
  std::int64_t frames_left_;
  std::string bytes_;
};

/// What C3dWriter puts before the frames. Errors as its create()'s.
[[nodiscard]] Result<std::string> c3d_head(const C3dInfo& info);

}  // namespace marey::recordings
