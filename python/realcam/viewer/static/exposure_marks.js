// What cameras draw over a picture, from its 8-bit codes: histogram, clipping, focus peaking.

const CLIPPED = 254; // JPEG moves codes by one or two
const PEAKING = 44; // codes by which the brightness of a pixel differs from its neighbours' where an edge is sharp

/// Counts of 64 bins for red, green, blue.
export function histogramOf(image) {
  const bins = [new Uint32Array(64), new Uint32Array(64), new Uint32Array(64)];
  const data = image.data;
  for (let i = 0; i < data.length; i += 4) for (let c = 0; c < 3; ++c) bins[c][data[i + c] >> 2] += 1;
  return bins;
}

/// Share of the pixels with a channel at its upper end.
export function clippedShare(image) {
  const data = image.data;
  let count = 0;
  for (let i = 0; i < data.length; i += 4)
    if (data[i] >= CLIPPED || data[i + 1] >= CLIPPED || data[i + 2] >= CLIPPED) count += 1;
  return count / (data.length / 4);
}

/// Marks in a picture of the same size: what is clipped as red stripes, sharp edges in yellow.
export function marksOf(image, { clipping, peaking }) {
  const { width, height, data } = image;
  const marks = new ImageData(width, height);
  const green = (x, y) => data[4 * (y * width + x) + 1];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const i = 4 * (y * width + x);
      const isClipped = data[i] >= CLIPPED || data[i + 1] >= CLIPPED || data[i + 2] >= CLIPPED;
      if (clipping && isClipped && (x + y) % 8 < 4) marks.data.set([255, 0, 60, 255], i);
      else if (peaking && x > 0 && y > 0 && x + 1 < width && y + 1 < height) {
        const laplacian =
          4 * green(x, y) - green(x - 1, y) - green(x + 1, y) - green(x, y - 1) - green(x, y + 1);
        if (Math.abs(laplacian) > PEAKING) marks.data.set([255, 230, 0, 255], i);
      }
    }
  return marks;
}

export function drawHistogram(canvas, bins) {
  const context = canvas.getContext("2d");
  const { width, height } = canvas;
  context.clearRect(0, 0, width, height);
  // The fullest bin but for the two ends, which hold what is black and what is clipped.
  const highest = Math.max(1, ...bins.flatMap((channel) => [...channel.subarray(1, 63)]));
  context.globalCompositeOperation = "screen";
  ["#e0453a", "#35b25f", "#4a7dff"].forEach((colour, c) => {
    context.fillStyle = colour;
    bins[c].forEach((count, k) => {
      const h = height * Math.min(1, count / highest);
      context.fillRect((k * width) / 64, height - h, width / 64, h);
    });
  });
  context.globalCompositeOperation = "source-over";
}
