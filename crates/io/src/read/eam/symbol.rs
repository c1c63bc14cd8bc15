//! Symbols of the elements by atomic number.

const SYMBOLS: &str = "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Kr \
Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu Hf Ta W Re Os Ir Pt \
Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu Am Cm Bk Cf Es Fm Md No Lr Rf Db Sg Bh Hs Mt Ds Rg Cn Nh Fl Mc Lv Ts Og";

/// "Cu" for 29.
pub(super) fn symbol(number: u32) -> Option<&'static str> {
    SYMBOLS
        .split_whitespace()
        .nth((number as usize).checked_sub(1)?)
}

#[cfg(test)]
mod tests {
    use super::symbol;

    #[test]
    fn symbols_stand_at_their_numbers() {
        let known = [
            (1, "H"),
            (13, "Al"),
            (29, "Cu"),
            (47, "Ag"),
            (79, "Au"),
            (92, "U"),
            (118, "Og"),
        ];
        for (number, name) in known {
            assert_eq!(symbol(number), Some(name));
        }
        assert_eq!((symbol(0), symbol(119)), (None, None));
    }
}
