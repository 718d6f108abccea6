// Sealed bytes: a state that is stored or sent, compressed, with a sum that tells damage.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sunder {

/// Returns bytes that unseal() of the same version of the program opens.
std::vector<std::byte> seal(std::span<const std::byte> content);
/// Returns what was sealed. Throws InputError, which begins with `name`, for bytes that are
/// damaged, of another version of the program, or of something else.
std::vector<std::byte> unseal(std::span<const std::byte> sealed, const std::string& name);

}  // namespace sunder
