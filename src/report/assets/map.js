// viridis (van der Walt & Smith, CC0), at nine places.
const VIRIDIS = ['440154', '472d7b', '3b528b', '2c728e', '21918c', '28ae80', '5ec962', 'addc30', 'fde725'].map(
  hex => [0, 2, 4].map(i => parseInt(hex.slice(i, i + 2), 16)));
function viridis(share) {
  const at = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1), low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[low].map((v, i) => v + (at - low) * (VIRIDIS[low + 1][i] - v));
}

// One pixel a cell; row 0 is the lowest, as in the map.
function raster(columns, rows, colorOfCell) {
  const canvas = Object.assign(document.createElement('canvas'), {width: columns, height: rows});
  const context = canvas.getContext('2d'), image = context.createImageData(columns, rows);
  for (let i = 0; i < columns * rows; ++i) {
    const color = colorOfCell(i);
    if (color) image.data.set(color, 4 * i);
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

const rgb = hex => [1, 3, 5].map(i => parseInt(hex.length === 4 ? hex[(i + 1) / 2] + hex[(i + 1) / 2] : hex.slice(i, i + 2), 16));

// The maps of a place as pictures, and how its cells lie in the map frame.
class Place {
  constructor(data) {
    this.data = data;
    const states = new Uint8Array(data.map.columns * data.map.rows);
    let at = 0;
    data.map.runs.forEach((run, i) => { states.fill(i % 3, at, at + run); at += run; });
    this.states = states;
    this.paint();
  }
  paint() {  // in today's colours
    const floor = [...rgb(css('--floor')), 255], wall = [...rgb(css('--wall')), 255], {map, field} = this.data;
    this.walls = raster(map.columns, map.rows, i => this.states[i] === 1 ? floor : this.states[i] === 2 ? wall : null);
    if (!field) return;
    const values = Uint8Array.from(atob(field.values), c => c.charCodeAt(0));
    this.colors = raster(field.columns, field.rows, i => values[i] === 255 ? null : [...viridis(values[i] / 254), 255]);
  }
  // Draws a picture whose cells lie as `grid` says, on a context that is in metres of the map.
  static draw(context, picture, grid) {
    context.save();
    context.translate(grid.x, grid.y);
    context.rotate(grid.yaw);
    context.scale(grid.resolution_m, grid.resolution_m);
    context.imageSmoothingEnabled = false;
    context.drawImage(picture, 0, 0);
    context.restore();
  }
  // The corners of what is known, in metres: [x0, y0, x1, y1].
  extent() {
    const {map} = this.data;
    const box = [Infinity, Infinity, -Infinity, -Infinity], c = Math.cos(map.yaw), s = Math.sin(map.yaw);
    for (const [u, v] of [[0, 0], [map.columns, 0], [0, map.rows], [map.columns, map.rows]]) {
      const x = map.x + map.resolution_m * (c * u - s * v), y = map.y + map.resolution_m * (s * u + c * v);
      box[0] = Math.min(box[0], x); box[1] = Math.min(box[1], y); box[2] = Math.max(box[2], x); box[3] = Math.max(box[3], y);
    }
    return box;
  }
}
