// Half floats (IEEE 754 binary16) to numbers, by a table.

const table = new Float32Array(65536);
for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, fraction = bits & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24
        : exponent < 31 ? (1 + fraction / 1024) * 2 ** (exponent - 15)
            : fraction ? NaN : Infinity;
    table[bits] = bits & 32768 ? -size : size;
}

/** The number of each of the 65536 half floats, at the index of its bits. @type {Float32Array} */
export const halfTable = table;
