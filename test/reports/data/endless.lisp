; Forty choices between two bits: more ways than anybody can try.
(defdomain endless (
  (:operator (!mark ?n ?bit) () ((marked ?n ?bit)))
  (:method (choose ?n) ((bit ?bit)) ((!mark ?n ?bit)))
  (:method (finish) ((never)) ())))

; Each way ends here in vain.
(defproblem forever endless ((bit zero) (bit one))
  ((choose n1) (choose n2) (choose n3) (choose n4) (choose n5) (choose n6) (choose n7) (choose n8)
   (choose n9) (choose n10) (choose n11) (choose n12) (choose n13) (choose n14) (choose n15) (choose n16)
   (choose n17) (choose n18) (choose n19) (choose n20) (choose n21) (choose n22) (choose n23) (choose n24)
   (choose n25) (choose n26) (choose n27) (choose n28) (choose n29) (choose n30) (choose n31) (choose n32)
   (choose n33) (choose n34) (choose n35) (choose n36) (choose n37) (choose n38) (choose n39) (choose n40)
   (finish)))

; Each way is a plan.
(defproblem many endless ((bit zero) (bit one))
  ((choose n1) (choose n2) (choose n3) (choose n4) (choose n5) (choose n6) (choose n7) (choose n8)
   (choose n9) (choose n10) (choose n11) (choose n12) (choose n13) (choose n14) (choose n15) (choose n16)
   (choose n17) (choose n18) (choose n19) (choose n20) (choose n21) (choose n22) (choose n23) (choose n24)
   (choose n25) (choose n26) (choose n27) (choose n28) (choose n29) (choose n30) (choose n31) (choose n32)
   (choose n33) (choose n34) (choose n35) (choose n36) (choose n37) (choose n38) (choose n39) (choose n40)))
