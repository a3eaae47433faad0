/** The address of the module, as bundlers give it to `load`. */
declare const address: string;
export default address;
