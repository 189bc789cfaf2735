// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/tar_writer.h"

#include <cstddef>
#include <utility>

#include "core/base/assert.h"
#include "core/base/format_text.h"

namespace marey::recordings {
namespace {

/// Places and widths of the fields (IEEE Std 1003.1-1988, 10.1.1).
struct TarField {
  std::size_t begin;
  std::size_t width;
};
constexpr TarField kName{0, 100};
constexpr TarField kMode{100, 8};
constexpr TarField kOwner{108, 8};
constexpr TarField kGroup{116, 8};
constexpr TarField kSize{124, 12};
constexpr TarField kTime{136, 12};
constexpr TarField kChecksum{148, 8};
constexpr TarField kKind{156, 1};
constexpr TarField kMagic{257, 8};
constexpr TarField kDeviceMajor{329, 8};
constexpr TarField kDeviceMinor{337, 8};

void set_text(std::string& header, TarField field, std::string_view text) {
  MAREY_ASSERT(text.size() <= field.width);
  header.replace(field.begin, text.size(), text);
}

/// Writes octal digits that fill the field, and a final zero byte.
void set_number(std::string& header, TarField field, std::uint64_t value) {
  const auto digits = static_cast<int>(field.width) - 1;
  set_text(header,
           field,
           format_text("%0*llo", digits, static_cast<unsigned long long>(value)));
}

}  // namespace

std::string tar_header(std::string_view name, std::uint64_t bytes) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 33U;
  MAREY_ASSERT(!name.empty() && name.size() <= kName.width && bytes < kMaxBytes);
  std::string header(512, '\0');
  set_text(header, kName, name);
  set_number(header, kMode, 0644);
  set_number(header, kOwner, 0);
  set_number(header, kGroup, 0);
  set_number(header, kSize, bytes);
  set_number(header, kTime, 0);
  set_text(header, kKind, "0");
  set_text(header, kMagic, std::string_view("ustar\00000", 8));
  set_number(header, kDeviceMajor, 0);
  set_number(header, kDeviceMinor, 0);
  // The sum counts its own field as blanks.
  set_text(header, kChecksum, "        ");
  std::uint64_t sum = 0;
  for (const char c : header) sum += static_cast<unsigned char>(c);
  const auto printed = format_text("%06llo", static_cast<unsigned long long>(sum));
  set_text(header, kChecksum, std::string_view((printed + '\0' + ' ').c_str(), 8));
  return header;
}

Result<TarWriter> TarWriter::create(const std::filesystem::path& path) {
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  return TarWriter(*std::move(file));
}

std::uint64_t TarWriter::size_of_entry(std::uint64_t bytes) {
  return kBlock + (bytes + kBlock - 1) / kBlock * kBlock;
}

void TarWriter::add(std::string_view name, std::string_view bytes) {
  file_.append(tar_header(name, bytes.size()));
  file_.append(bytes);
  const std::uint64_t padded = size_of_entry(bytes.size()) - kBlock;
  file_.append(std::string(static_cast<std::size_t>(padded - bytes.size()), '\0'));
  written_ += kBlock + padded;
}

Status TarWriter::commit() {
  file_.append(std::string(static_cast<std::size_t>(kEnd), '\0'));
  written_ += kEnd;
  return file_.commit();
}

}  // namespace marey::recordings
