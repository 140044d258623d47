// Camera overlays computed from 8-bit codes: histogram, clipping, focus peaking.

const CLIPPED = 254; // smallest code that counts as clipped: JPEG changes 255 by one
const PEAKING = 44; // smallest response of the Laplacian below at a sharp edge, in codes
const SIGNIFICANCE = 4; // smallest response at an edge, in standard deviations of its noise
const NOISE_GAIN = Math.sqrt(20); // noise gain of the Laplacian below: root of the sum of its squared weights

/// Histograms of 64 bins for red, green, blue.
export function histogramOf(image) {
  const bins = [new Uint32Array(64), new Uint32Array(64), new Uint32Array(64)];
  const data = image.data;
  for (let i = 0; i < data.length; i += 4) for (let c = 0; c < 3; ++c) bins[c][data[i + c] >> 2] += 1;
  return bins;
}

/// True if a channel of the pixel at an index of the data is clipped.
const isClipped = (data, i) => data[i] >= CLIPPED || data[i + 1] >= CLIPPED || data[i + 2] >= CLIPPED;

/// Fraction of the pixels with a clipped channel.
export function clippedShare(image) {
  const data = image.data;
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (isClipped(data, i)) count += 1;
  return count / (data.length / 4);
}

/// Returns an overlay of the same size: clipped pixels as red stripes, sharp edges in yellow. noise: RMS noise of tiles
/// of the picture, in codes, as rows of numbers; without it, edges cannot be told from noise and none is marked.
export function marksOf(image, { clipping, peaking, noise = null }) {
  const { width, height, data } = image;
  const marks = new ImageData(width, height);
  const isEdge = peaking && noise ? sharpEdges(image, noise) : null;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const k = y * width + x, i = 4 * k;
      if (clipping && isClipped(data, i) && (x + y) % 8 < 4) marks.data.set([255, 0, 60, 255], i);
      else if (isEdge && isEdge[k]) marks.data.set([255, 230, 0, 255], i);
    }
  return marks;
}

/// Returns 1 for pixels whose Laplacian of green exceeds the noise, and that have at least two such neighbours: an edge
/// is a line, noise is not.
function sharpEdges({ width, height, data }, noise) {
  const green = new Uint8ClampedArray(width * height);
  for (let k = 0; k < green.length; ++k) green[k] = data[4 * k + 1];
  const smoothed = green.slice(); // without isolated brighter or darker pixels, which are outliers of the samples
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {
      const k = y * width + x;
      let low = 255, high = 0;
      for (let dy = -width; dy <= width; dy += width)
        for (let dx = -1; dx <= 1; ++dx) {
          if (dx === 0 && dy === 0) continue;
          const value = green[k + dy + dx];
          if (value < low) low = value;
          if (value > high) high = value;
        }
      smoothed[k] = Math.min(high, Math.max(low, green[k]));
    }
  const laplacian = new Float32Array(width * height);
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {
      const k = y * width + x;
      laplacian[k] = Math.abs(
        4 * smoothed[k] - smoothed[k - 1] - smoothed[k + 1] - smoothed[k - width] - smoothed[k + width],
      );
    }
  const isSignificant = new Uint8Array(width * height);
  for (let y = 0; y < height; ++y) {
    const row = noise[Math.floor((y * noise.length) / height)];
    for (let x = 0; x < width; ++x) {
      const deviation = row[Math.floor((x * row.length) / width)];
      isSignificant[y * width + x] = laplacian[y * width + x] > Math.max(PEAKING, SIGNIFICANCE * NOISE_GAIN * deviation) ? 1 : 0;
    }
  }
  const isEdge = new Uint8Array(width * height);
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {
      const k = y * width + x;
      if (!isSignificant[k]) continue;
      let neighbours = -1; // without the pixel itself
      for (let dy = -width; dy <= width; dy += width) for (let dx = -1; dx <= 1; ++dx) neighbours += isSignificant[k + dy + dx];
      isEdge[k] = neighbours >= 2 ? 1 : 0;
    }
  return isEdge;
}

/// Draws the histograms of histogramOf().
export function drawHistogram(canvas, bins) {
  const context = canvas.getContext("2d");
  const { width, height } = canvas;
  context.clearRect(0, 0, width, height);
  // The fullest bin except for the two ends, which hold black and clipped pixels.
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
