// The container of binary glTF 2.0 (specification, section 4.4): a JSON chunk and at most one BIN
// chunk.
#pragma once

#include "runtime/result.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

struct GlbView {
    std::string_view json;
    std::span<const std::byte> bin; // empty where the file has none; padding included
};

// Views into `bytes`. The lengths of file and chunks must fit each other; chunks of other types are
// skipped, as the specification asks.
Result<GlbView> readGlb(std::span<const std::byte> bytes);

// `json` and `bin` padded to 4 bytes, below 4 GiB in all.
Result<std::vector<std::byte>> writeGlb(const std::string& json, std::span<const std::byte> bin);

} // namespace penumbra
