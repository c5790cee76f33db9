// SPDX-License-Identifier: BSD-3-Clause
// A plugin for qemu-user: counts how often each block of instructions is executed, and prints the blocks that
// the time goes to.
//   qemu-aarch64 -plugin libcount_blocks.so -d plugin -D OUT PROGRAM...
// OUT gets a line "instructions N" and then, hottest first, "block ADDRESS INSTRUCTIONS EXECUTIONS".
//
// Debian ships no header for plugins, so what is used of the interface (version 1, qemu's
// docs/devel/tcg-plugins) is declared here.
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

extern "C" {
using qemu_plugin_id_t = std::uint64_t;
struct qemu_info_t;
struct qemu_plugin_tb;
enum qemu_plugin_op { QEMU_PLUGIN_INLINE_ADD_U64 };
using TranslatedCall = void (*)(qemu_plugin_id_t, qemu_plugin_tb*);
using ExitCall = void (*)(qemu_plugin_id_t, void*);

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t, TranslatedCall);
void qemu_plugin_register_vcpu_tb_exec_inline(qemu_plugin_tb*, qemu_plugin_op, void* counter,
                                              std::uint64_t add);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t, ExitCall, void*);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb*);
std::uint64_t qemu_plugin_tb_vaddr(const qemu_plugin_tb*);
void qemu_plugin_outs(const char*);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;
__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t*, int,
                                                               char**);
}

namespace {

using BlockKey = std::pair<std::uint64_t, std::size_t>;  // address, instructions

std::mutex mutex;
std::map<BlockKey, std::unique_ptr<std::uint64_t>> executions;  // the counters must not move

void translated(qemu_plugin_id_t, qemu_plugin_tb* block) {
  const std::lock_guard lock(mutex);
  std::unique_ptr<std::uint64_t>& counter =
      executions[{qemu_plugin_tb_vaddr(block), qemu_plugin_tb_n_insns(block)}];
  if (!counter) counter = std::make_unique<std::uint64_t>(0);
  qemu_plugin_register_vcpu_tb_exec_inline(block, QEMU_PLUGIN_INLINE_ADD_U64, counter.get(), 1);
}

void print_counts(qemu_plugin_id_t, void*) {
  const std::lock_guard lock(mutex);
  std::vector<std::pair<BlockKey, std::uint64_t>> blocks;
  std::uint64_t instructions = 0;
  for (const auto& [key, counter] : executions) {
    blocks.emplace_back(key, *counter);
    instructions += key.second * *counter;
  }
  std::sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) {
    return a.first.second * a.second > b.first.second * b.second;
  });
  std::array<char, 128> line{};
  std::snprintf(line.data(), line.size(), "instructions %" PRIu64 "\n", instructions);
  qemu_plugin_outs(line.data());
  for (const auto& [key, count] : blocks) {
    std::snprintf(line.data(), line.size(), "block 0x%" PRIx64 " %zu %" PRIu64 "\n", key.first, key.second,
                  count);
    qemu_plugin_outs(line.data());
  }
}

}  // namespace

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t*, int, char**) {
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, print_counts, nullptr);
  return 0;
}
