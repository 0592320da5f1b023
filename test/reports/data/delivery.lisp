; A thing is brought to somebody, on foot (cost 5) or by bus (cost 2); handing it over costs 1.
(defdomain delivery (
  (:operator (!walk ?from ?to) ((at ?from)) ((at ?from)) ((at ?to)) 5)
  (:operator (!ride ?from ?to) ((at ?from)) ((at ?from)) ((at ?to)) 2)
  (:operator (!hand_over ?thing ?who)
    ((has ?thing) (lives ?who ?place) (at ?place))
    ((has ?thing))
    ((given ?thing ?who)))

  (:method (travel ?to) on_foot ((at ?from) (path ?from ?to)) ((!walk ?from ?to)))
  (:method (travel ?to) by_bus ((at ?from) (bus ?from ?to)) ((!ride ?from ?to)))
  (:method (deliver ?thing ?who)
    ((lives ?who ?place))
    ((travel ?place) (!hand_over ?thing ?who)))))

(defproblem two_ways delivery
  ((at home) (has parcel) (lives anna park) (path home park) (bus home park))
  ((deliver parcel anna)))

(defproblem no_way delivery
  ((at home) (has parcel) (lives anna island) (path home park))
  ((deliver parcel anna)))
