// SPDX-License-Identifier: BSD-3-Clause
// Whether a sanitizer watches this build: it makes everything several times slower.
#pragma once

namespace stereod {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace stereod
