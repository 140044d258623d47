"""Example command lines at the end of `--help`, for each command in Python."""

from __future__ import annotations

EXAMPLES: dict[str, tuple[str, ...]] = {
    "lens list": (
        "realcam lens list",
        "realcam lens list --focal-length 35-70 --f-number 2",
        "realcam lens list zeiss --kind wide --json",
    ),
    "lens plot": (
        "realcam lens plot mtf-field tessar-50mm -o mtf.svg -o mtf.csv",
        "realcam lens plot spot double-gauss-50mm --f-number 4 --focus 2 --fields-deg 0,10,20",
    ),
    "lens report": ("realcam lens report tessar-50mm --f-number 5.6 -o tessar.pdf",),
    "lens image": (
        "realcam lens image double-gauss-50mm chart.png -o seen.png --f-number 2.8 --psfs",
        "realcam lens image tessar-50mm chart.png -o near.png --object-distance 0.5 --height 0.3 --crop 0,0,400,300",
        "realcam lens image fisheye-6mm-220deg sky.jpg -o dome.png --height-deg 180 --projection angle",
    ),
    "lens draw": (
        "realcam lens draw fisheye-6mm-220deg -o fisheye.svg",
        "realcam lens draw double-gauss-50mm --focus 0.6 --f-number 2.8 --marks --theme dark",
    ),
    "lens photo": (
        "realcam lens photo double-gauss-50mm --focus 3 --f-number 5.6",
        "realcam lens photo tessar-50mm --exposure-time 1/125 --iso 400 --json",
    ),
    "lens compare": ("realcam lens compare tessar-50mm sonnar-50mm --mtf 10,30 -o both.svg",),
    "lens convert": ("realcam lens convert tessar-50mm -o tessar.zmx",),
    "lens rays": (
        "realcam lens rays double-gauss-50mm -o rays.npz --f-number 4 --focus inf",
        "realcam lens rays mine.zmx -o rays.npz --rays 100000 --wavelengths 486,588,656",
    ),
    "lens fit": ("realcam lens fit rays.npz -o black-box.npz",),
    "lens blender": ("realcam lens blender -o realcam-lenses.zip",),
    "lens gallery": (
        "realcam lens gallery -o lenses.png",
        "realcam lens gallery tessar-50mm sonnar-50mm --columns 2 -o two.svg",
    ),
    "lens optimise": (
        "realcam lens optimise tessar-50mm -o sharper.toml",
        "realcam lens optimise mine.zmx -o better.zmx --vary radii --vary thickness:3 --fields-deg 0,14 --glasses",
    ),
    "lens tolerance": (
        "realcam lens tolerance double-gauss-50mm --f-number 2.8 --grade commercial -o report.html",
        "realcam lens tolerance mine.toml --copies 200 --compensate refocus,film_tilt --json",
    ),
    "sensor list": ("realcam sensor list",),
    "sensor info": ("realcam sensor info sony-imx071-color",),
    "calibration show": ("realcam calibration show camchain.yaml",),
    "calibration convert": (
        "realcam calibration convert camera_info.yaml cameras.txt",
        "realcam calibration convert camchain.yaml left.yml --camera cam0 --to opencv",
    ),
    "calibration undistort": ("realcam calibration undistort camera_info.yaml picture.png -o flat.png",),
    "expose": (
        "realcam render scene.glb -o film.exr",
        "realcam expose film.exr --sensor sony-imx071-color --iso 800 -o raw.dng -o raw.png",
    ),
    "demo": ("realcam demo -o pictures --spp 200",),
    "bench": ("realcam bench lens-rays frame --json",),
    "cost": ("realcam cost demo -o cost.html",),
    "compare": (
        "realcam compare demo --vary f_number=2.8,4,8 -o sheet.png",
        "realcam compare demo --vary lens=wide-24mm,double-gauss-50mm,sonnar-180mm --f-number 4 -o sheet.jpg",
    ),
    "job": (
        "realcam job make terrace.toml -o terrace.job",
        "realcam job work terrace.job",
        "realcam job finish terrace.job -o terrace.exr",
    ),
    "job make": (
        "realcam job make terrace.toml -o terrace.job",
        "realcam job make ball.toml -o ball.job --frames 1-48 --spp 256",
        "realcam job make *.toml -o night.job --spp 1024 --sbatch night.sbatch --tasks 40",
    ),
    "job work": (
        "realcam job work terrace.job",
        "realcam job work terrace.job --scheduler tcp://head:8786",
        "realcam job work terrace.job --part 3/8",
    ),
    "job status": ("realcam job status terrace.job --json",),
    "job finish": (
        "realcam job finish terrace.job -o terrace.exr -o terrace.png",
        "realcam job finish night.job -o pictures --format png",
        "realcam job finish ball.job -o ball.mp4",
    ),
    "dataset": (
        "realcam dataset recipe.toml -o pictures",
        "realcam dataset recipe.toml -o pictures --count 1000 --workers 8",
        "realcam dataset recipe.toml -o pictures --sbatch night.sbatch --tasks 100",
    ),
    "view": (
        "realcam view demo",
        "realcam view shot.toml --port 8081 --no-browser",
    ),
}
