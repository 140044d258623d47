# Embeds sensors/*.toml, so that a sensor is found by its name wherever the program or the extension is.
include(RealcamEmbeddedFiles)
file(GLOB sensor_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/sensors/*.toml)
realcam_embed_files(REALCAM_SENSOR_FILES_SOURCE sensor io/sensor/sensor_file ${sensor_files})
