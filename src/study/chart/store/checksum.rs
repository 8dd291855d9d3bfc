//! Checksum of a block: the codec `crc32c` of zarr, which appends the CRC-32C (Castagnoli) of the bytes before it.

/// Generator polynomial, the lowest bit first (RFC 3720, appendix B.4).
const POLYNOMIAL: u32 = 0x82F6_3B78;
/// Number of bytes of a checksum.
pub(super) const LENGTH: usize = 4;

const fn table() -> [u32; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < table.len() {
        let (mut rest, mut bit) = (byte as u32, 0);
        while bit < u8::BITS {
            rest = (rest >> 1) ^ (POLYNOMIAL * (rest & 1));
            bit += 1;
        }
        table[byte] = rest;
        byte += 1;
    }
    table
}

const TABLE: [u32; 256] = table();

/// Returns the CRC-32C of some bytes.
pub(super) fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |rest, byte| TABLE[usize::from(rest as u8 ^ byte)] ^ (rest >> 8))
}

/// Appends the checksum of some bytes to them.
pub(super) fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(crc32c(&bytes).to_le_bytes());
    bytes
}

/// Whether some bytes end in the checksum of those before it.
pub(super) fn is_sealed(bytes: &[u8]) -> bool {
    bytes.split_last_chunk().is_some_and(|(data, sum)| crc32c(data) == u32::from_le_bytes(*sum))
}
