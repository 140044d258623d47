"""The pictures of the lens bench: previews, progressive refinement, metering and denoising."""
