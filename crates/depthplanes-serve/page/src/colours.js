// Colours of depth. Planes have those that the server says.

/** Viridis as polynomials of 6th degree, by Matt Zucker (CC0). */
const VIRIDIS = [
    [0.2777273272, 0.0054073445, 0.3340998053], [0.1050930431, 1.4046135299, 1.3845901627],
    [-0.3308618287, 0.2148475595, 0.0950951630], [-4.6342304984, -5.7991009734, -19.3324409563],
    [6.2282699363, 14.1799333668, 56.6905526007], [4.7763849977, -13.7451453777, -65.3530326334],
    [-5.4354558559, 4.6458526122, 26.3124352496],
];

/** The colour of a share from 0 (far) to 1 (near). */
export function viridis(share) {
    return [0, 1, 2].map(channel => {
        const value = VIRIDIS.reduceRight((sum, factors) => sum * share + factors[channel], 0);
        return Math.round(255 * Math.min(1, Math.max(0, value)));
    });
}

/** Grey, light where it is near. */
export const grey = share => Array(3).fill(Math.round(38 + 190 * share));

const MISSING = [15, 18, 22];

/** What each mark of the ground looks like: 1 floor, 2 obstacle, 4 drop; none of unknown pixels and those overhead. */
export const MARKS = [null, [46, 190, 110], [232, 84, 72], null, [72, 120, 250], null, null, null, null];

const SAMPLES = 5000;

/** The range of depth that is told apart by colours; it follows the frames slowly, so that nothing flickers. */
export class Range {
    follow(frame, anew) {
        const stride = Math.max(1, Math.floor(frame.depth.length / SAMPLES));
        const codes = frame.depth.filter((code, at) => at % stride === 0 && code > 0).sort();
        if (codes.length === 0) return;
        const value = share => frame.low + (codes[Math.floor(share * (codes.length - 1))] - 1) * frame.scale;
        const [near, far] = [value(0.01), value(0.99)];
        const slow = anew || this.near === undefined ? 1 : 0.15;
        this.near = slow * near + (1 - slow) * (this.near ?? 0);
        this.far = slow * far + (1 - slow) * (this.far ?? 0);
    }

    /** A colour for each code of a frame, `colour` of its share; the byte order is that of canvases. */
    table(frame, colour) {
        const shades = Array.from({ length: 257 }, (_, at) => pack(colour(at / 256)));
        const table = new Uint32Array(65536).fill(pack(MISSING));
        // Steps of equal ratio: what is near is told apart more finely.
        const isDepth = frame.unit === "m" && this.near > 0 && this.far > this.near;
        const width = isDepth ? Math.log(this.far / this.near) : this.far - this.near || 1;
        for (let code = 1; code < 65536; code++) {
            const value = frame.low + (code - 1) * frame.scale;
            const far = isDepth ? Math.log(value / this.near) / width : 1 - (value - this.near) / width;
            table[code] = shades[Math.round(256 * (1 - Math.min(1, Math.max(0, far))))];
        }
        return table;
    }
}

const pack = ([r, g, b]) => (255 << 24) | (b << 16) | (g << 8) | r;
export const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;
