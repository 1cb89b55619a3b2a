// The Vulkan instance and its validation log.
//   Result<Instance> instance = createInstance({.validation = true});
//   if (!instance) return instance.error();   // no driver: says which package to install
#pragma once

#include "runtime/vk/check.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace penumbra {

struct InstanceOptions {
    std::string applicationName = "penumbra";
    std::vector<std::string> extensions; // what a window needs, e.g. from GLFW; empty headless
    bool validation = false;             // core and synchronisation validation
    bool gpuAssistedValidation = false;  // finds out-of-range addresses; 3-6 times slower
    bool echoMessages = true;            // validation messages also go to stderr
};

struct ValidationLog; // written by any thread that calls Vulkan

// Outlives every device made from it. Move-only.
class Instance {
public:
    explicit Instance(VkInstance handle, VkDebugUtilsMessengerEXT messenger,
                      std::unique_ptr<ValidationLog> log, bool debugUtils);
    Instance(Instance&&) noexcept;
    Instance& operator=(Instance&&) = delete;
    ~Instance();

    VkInstance handle = VK_NULL_HANDLE;
    bool debugUtils = false; // names and labels are available

    // Errors and warnings so far, oldest first; the text is kept for the first 256.
    [[nodiscard]] std::uint64_t validationCount() const;
    [[nodiscard]] std::vector<std::string> validationMessages() const;
    void clearValidationMessages();

private:
    VkDebugUtilsMessengerEXT m_messenger = VK_NULL_HANDLE;
    std::unique_ptr<ValidationLog> m_log;
};

// Errors: no driver on this machine, validation layer or window extension not installed; the
// message names the remedy.
Result<Instance> createInstance(const InstanceOptions& options = {});

[[nodiscard]] Error noDeviceError(); // the one message for "this machine has no Vulkan device"

} // namespace penumbra
