// What cameras draw over a picture, from its 8-bit codes: histogram, clipping, focus peaking.

const CLIPPED = 254; // JPEG moves codes by one or two
const PEAKING = 44; // codes by which the brightness of a pixel differs from its neighbours' where an edge is sharp
const SURE = 4; // standard deviations of the noise by which an edge has to stand out of it
const NOISE_GAIN = Math.sqrt(20); // of the Laplacian below: the root of the sum of its squared weights

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

/// Marks in a picture of the same size: what is clipped as red stripes, sharp edges in yellow. noise: of parts of the
/// picture, in codes, as rows of numbers; without it nothing tells edges from noise, and no edge is marked.
export function marksOf(image, { clipping, peaking, noise = null }) {
  const { width, height, data } = image;
  const marks = new ImageData(width, height);
  const isEdge = peaking && noise ? sharpEdges(image, noise) : null;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const k = y * width + x, i = 4 * k;
      const isClipped = data[i] >= CLIPPED || data[i + 1] >= CLIPPED || data[i + 2] >= CLIPPED;
      if (clipping && isClipped && (x + y) % 8 < 4) marks.data.set([255, 0, 60, 255], i);
      else if (isEdge && isEdge[k]) marks.data.set([255, 230, 0, 255], i);
    }
  return marks;
}

/// Where the brightness bends by more than noise does, at neighbouring pixels: an edge is a line, noise is not.
function sharpEdges({ width, height, data }, noise) {
  // A pixel that is brighter or darker than all around it is no edge, but a rare sample.
  const green = new Uint8ClampedArray(width * height);
  for (let k = 0; k < green.length; ++k) green[k] = data[4 * k + 1];
  const even = green.slice();
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
      even[k] = Math.min(high, Math.max(low, green[k]));
    }
  const bends = new Float32Array(width * height);
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {
      const k = y * width + x;
      bends[k] = Math.abs(4 * even[k] - even[k - 1] - even[k + 1] - even[k - width] - even[k + width]);
    }
  const stands = new Uint8Array(width * height);
  for (let y = 0; y < height; ++y) {
    const row = noise[Math.floor((y * noise.length) / height)];
    for (let x = 0; x < width; ++x) {
      const deviation = row[Math.floor((x * row.length) / width)];
      stands[y * width + x] = bends[y * width + x] > Math.max(PEAKING, SURE * NOISE_GAIN * deviation) ? 1 : 0;
    }
  }
  const isEdge = new Uint8Array(width * height);
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {
      const k = y * width + x;
      if (!stands[k]) continue;
      let near = -1;
      for (let dy = -width; dy <= width; dy += width) for (let dx = -1; dx <= 1; ++dx) near += stands[k + dy + dx];
      isEdge[k] = near >= 2 ? 1 : 0;
    }
  return isEdge;
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
