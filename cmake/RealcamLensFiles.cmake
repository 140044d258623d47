# Embeds lenses/*.toml, so that a lens is found by its name wherever the program or the extension is.
include(RealcamEmbeddedFiles)
file(GLOB lens_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lenses/*.toml)
realcam_embed_files(REALCAM_LENS_FILES_SOURCE lens io/lens/lens_text ${lens_files})
