// Arrays of the page: base64, compressed, differences of numbers of 16 bits or more. Each is unpacked once, when it is needed.

class Arrays {
  constructor(list) {
    this.list = list;
    this.known = new Map();
  }

  /** Values of an array; those that are no numbers are NaN. */
  get(number) {
    if (!this.known.has(number)) this.known.set(number, this.unpack(this.list[number]));
    return this.known.get(number);
  }

  async unpack({ count, range, bytes = 2, data }) {
    if (count === 0) return range ? new Float32Array(0) : new Uint32Array(0);
    const text = atob(data);
    const packed = Uint8Array.from(text, (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const planes = new Uint8Array(await new Response(stream).arrayBuffer());
    const out = range ? new Float32Array(count) : new Uint32Array(count);
    const mask = bytes === 2 ? 0xffff : 0xffffffff;
    let value = 0;
    for (let k = 0; k < count; k++) {
      let difference = 0;
      for (let plane = 0; plane < bytes; plane++) difference = difference * 256 + planes[plane * count + k];
      value = bytes === 2 ? (value + difference) & mask : (value + difference) >>> 0;
      if (!range) out[k] = value;
      else out[k] = value === 65535 ? NaN : range[0] + ((range[1] - range[0]) * value) / 65534;
    }
    return out;
  }
}
