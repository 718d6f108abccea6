#include "scenes/timing/hash_book.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "engine/base/check.h"
#include "scenes/file/text_file.h"

namespace sunder::scenes {
namespace {

bool is_hash(const std::string& what, const std::string& text) {
  const bool has_shortened = what.starts_with("frames/") || what.starts_with("seconds/");
  const bool whole = has_shortened ? text.size() % 4 == 0 : text.size() == 16;
  return whole && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

StateHashes parse_hashes(const std::string& text, const std::string& file) {
  StateHashes book;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string what, hash, more;
    if (!(words >> what)) continue;
    const std::string at = file + ":" + std::to_string(number) + ": ";
    if (!(words >> hash) || !is_hash(what, hash) || words >> more) {
      throw InputError(at + "expected KEY and 16 hexadecimal digits (0-9, a-f), as in " +
                       "state/house/realtime/200 0123456789abcdef, or 4 digits per frame or second "
                       "if KEY begins with frames/ or seconds/");
    }
    if (!book.emplace(what, hash).second) {
      throw InputError(at + what + " is a duplicate key; remove the wrong line");
    }
  }
  return book;
}

StateHashes read_hashes(const std::string& file) {
  if (!std::filesystem::exists(file)) return {};
  return parse_hashes(read_text(file, file_kinds::kText), file);
}

std::string format_hashes(const StateHashes& book) {
  std::string text =
      "# Stored state hashes. Only `sunder bench --accept` and `sunder golden accept` change this\n"
      "# file. A changed line means that the simulated motion has changed; the commit says why.\n";
  std::size_t widest = 0;
  for (const auto& [what, hash] : book) widest = std::max(widest, what.size());
  for (const auto& [what, hash] : book)
    text += what + std::string(widest + 2 - what.size(), ' ') + hash + "\n";
  return text;
}

}  // namespace sunder::scenes
