; A waiter that looks at a guest before it says good day. State as in restaurant.lisp of hires, of
; which only (RobotAt area) and (At guest sitting-area) are needed.

(defdomain greeting (

; Turns on the spot. Where it stands after that is where it stood, seen from somewhere else: it is
; at no area in particular.
(:operator (!turn_towards ?area ?motion_set)
  ((RobotAt ?from))
  ()
  ())

(:operator (!imagine ?action . ?lists)
  ()
  ()
  ()
  0)

; How fast to turn is imagined; `fast` stands in the plan until the answer takes its place.
(:method (greet ?guest)
  ((At ?guest ?seat) (preferred ?seat ?set))
  ((!imagine !turn_towards (?seat) (slow fast)) (!turn_towards ?seat ?set)))

; What imagination found to fail is named with its exclamation mark or without.
(:- (preferred ?seat fast) ((not (fails ?seat fast))))
(:- (preferred ?seat slow) ((fails ?seat fast) (not (fails ?seat slow))))
(:- (fails ?seat ?set) ((imagined_failure turn_towards ?seat ?set)))
(:- (fails ?seat ?set) ((imagined_failure !turn_towards ?seat ?set)))

))
