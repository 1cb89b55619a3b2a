# shader rule: see runtime/vk
